// One buffer of vertices and one of triangles for all surfaces of a picture.
#include "render/surfaces.h"

#include <algorithm>

#include "render/geometry.h"
#include "render/shaders.h"

namespace render {
namespace {

const Vec3f kNoLine = Vec3f::Constant(0.5f);  // lines run through whole numbers

}  // namespace

Surfaces::Surfaces(const std::string& defines)
    : colorProgram_(makeProgram(kSurfaceVertex, kBodyFragment, "#define SURFACE\n" + defines)),
      casterProgram_(makeProgram(kSurfaceVertex, kCasterFragment, "#define CASTER\n")),
      array_(makeVertexArray()),
      vertexBuffer_(makeBuffer()),
      indexBuffer_(makeBuffer()),
      tints_(glGetUniformLocation(colorProgram_, "tints")) {
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer_);
  setAttribute(0, 3, sizeof(SurfaceVertex), offsetof(SurfaceVertex, position));
  setAttribute(1, 3, sizeof(SurfaceVertex), offsetof(SurfaceVertex, normal));
  setAttribute(2, 3, sizeof(SurfaceVertex), offsetof(SurfaceVertex, cell));
}

void Surfaces::append(const Vec3f& p, const Vec3f& n, const Vec3f& cell) {
  vertices_.push_back(
      {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, {cell.x(), cell.y(), cell.z()}});
}

// Corners of their own, of whose coordinates each is zero on one edge.
void Surfaces::appendFacets(const Surface& surface, const std::vector<Vec3f>& positions) {
  const std::vector<Vec3f> normals = creasedNormals(surface.positions, surface.indices);
  for (std::size_t i = 0; i < surface.indices.size(); ++i) {
    indices_.push_back(static_cast<std::uint32_t>(vertices_.size()));
    append(positions[surface.indices[i]], normals[i], Vec3f::Unit(static_cast<int>(i % 3)));
  }
}

void Surfaces::append(const Surface& surface) {
  const std::vector<Vec3f> normals = smoothNormals(surface.positions, surface.indices);
  std::vector<Vec3f> positions = surface.positions;
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += surface.offset * normals[i];
  if (surface.edges && surface.grid.empty()) return appendFacets(surface, positions);
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Vec3f cell = kNoLine;
    if (!surface.grid.empty()) cell.head<2>() = surface.grid[i];
    append(positions[i], normals[i], cell);
  }
  for (const std::uint32_t index : surface.indices) indices_.push_back(first + index);
}

void Surfaces::arrange(const Picture& picture, const Frame& frame) {
  vertices_.clear();
  indices_.clear();
  batches_.clear();
  for (const Surface& surface : picture.surfaces) {
    if (surface.indices.empty() || surface.color.w() <= 0) continue;
    const std::size_t first = indices_.size();
    append(surface);
    Vec3f center = Vec3f::Zero();
    for (const Vec3f& p : surface.positions) center += p;
    const float depth = frame.depthOf(center / static_cast<float>(surface.positions.size()));
    batches_.push_back({first, static_cast<GLsizei>(surface.indices.size()), depth,
                        linearColor(surface.color), linearColor(surface.backColor)});
  }
  std::stable_sort(batches_.begin(), batches_.end(),
                   [](const Batch& a, const Batch& b) { return a.depth > b.depth; });
  if (batches_.empty()) return;
  glBindVertexArray(array_);
  fillBuffer(GL_ARRAY_BUFFER, vertexBuffer_, vertices_, GL_STREAM_DRAW);
  fillBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer_, indices_, GL_STREAM_DRAW);
}

void Surfaces::drawTriangles(const Batch& batch) const {
  glDrawElements(GL_TRIANGLES, batch.count, GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(batch.first * sizeof(std::uint32_t)));
}

void Surfaces::draw(const Batch& batch) const {
  glUseProgram(colorProgram_);
  glBindVertexArray(array_);
  const std::array<Color, 2> tints = {batch.front, batch.back};
  glUniform4fv(tints_, 2, tints[0].data());
  drawTriangles(batch);
}

bool Surfaces::cast() const {
  return std::any_of(batches_.begin(), batches_.end(), [](const Batch& b) { return b.casts(); });
}

void Surfaces::drawCasters() const {
  glUseProgram(casterProgram_);
  glBindVertexArray(array_);
  for (const Batch& batch : batches_)
    if (batch.casts()) drawTriangles(batch);
}

void Surfaces::drawOpaque() const {
  for (const Batch& batch : batches_)
    if (batch.opaque()) draw(batch);
}

void Surfaces::drawTranslucent() const {
  glEnable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  for (const Batch& batch : batches_) {
    if (batch.opaque()) continue;
    for (const GLenum hidden : {GL_FRONT, GL_BACK}) {
      glCullFace(hidden);
      draw(batch);
    }
  }
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
}

}  // namespace render
