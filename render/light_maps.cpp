// A tile a light, each from its own matrix.
#include "render/light_maps.h"

#include <numeric>

namespace render {

static_assert(1 + kSkies == 4, "two tiles a side");

LightMaps::LightMaps(int tileSize)
    : tile_(tileSize), map_(makeDepthMap(2 * tileSize, "the light maps")) {}

void LightMaps::draw(Bodies& bodies, const Surfaces& surfaces, const Frame& frame, GLuint uniforms,
                     DrawCounts& counts) {
  std::vector<std::size_t> all(bodies.casters().size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  glBindFramebuffer(GL_FRAMEBUFFER, map_.framebuffer);
  glClear(GL_DEPTH_BUFFER_BIT);
  FrameBlock block = frame.block;
  const CasterState state;
  for (int light = 0; light <= kSkies; ++light) {
    block.toShadow = frame.block.toLights[static_cast<std::size_t>(light)];
    fillUniforms(uniforms, block);
    glViewport(tile_ * (light & 1), tile_ * (light >> 1), tile_, tile_);
    bodies.drawCasters(all);
    surfaces.drawCasters();
  }
  fillUniforms(uniforms, frame.block);
  counts.casters += static_cast<std::int64_t>(all.size()) * (1 + kSkies);
  counts.shadowMaps += 1 + kSkies;
  bindTexture(kLightsUnit, GL_TEXTURE_2D, map_.texture);
}

}  // namespace render
