// Draws one of the sample pictures to a PNG, to look at and to compare over processes.
//   draw_sample sample|pyramid|ragdoll|cloth|hud draft|standard|paper FILE.png [WIDTH HEIGHT]
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "render/png.h"
#include "render/renderer.h"
#include "sample.h"

namespace {

render::Picture pictureNamed(const std::string& name) {
  if (name == "pyramid") return render::pyramidPicture(20);
  if (name == "ragdoll") return render::ragdollPicture(20);
  if (name == "cloth") return render::clothPicture(60);
  render::Picture picture = render::samplePicture();
  if (name == "hud") picture.hud = render::sampleHud(90);
  return picture;
}

render::Quality qualityNamed(const std::string& name) {
  if (name == "draft") return render::Quality::kDraft;
  return name == "paper" ? render::Quality::kPaper : render::Quality::kStandard;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) {
    std::fputs("draw_sample PICTURE QUALITY FILE.png [WIDTH HEIGHT]\n", stderr);
    return 2;
  }
  render::RendererOptions options;
  options.quality = qualityNamed(argv[2]);
  if (argc > 5) {
    options.width = std::atoi(argv[4]);
    options.height = std::atoi(argv[5]);
  }
  render::Renderer renderer(options);
  render::writePng(renderer.draw(pictureNamed(argv[1])), argv[3]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
