// Picture in, Image out. Owns an OSMesa context; one Renderer per thread, any number of them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "render/image.h"
#include "render/picture.h"

namespace render {

enum class Quality { kDraft, kStandard, kPaper };

struct RendererOptions {
  int width = 1280, height = 720;
  Quality quality = Quality::kStandard;
  std::string fontFile;  // TrueType; empty: the shipped font beside the program's assets
};

// What a Renderer has drawn so far. A pass that no picture asked for stays at zero.
struct DrawCounts {
  std::int64_t pictures = 0;
  std::int64_t shadowMaps = 0;   // drawn, where something moved since the last picture
  std::int64_t casters = 0;      // bodies drawn into them
  std::int64_t shadowMasks = 0;  // soft shadows on the ground, filtered
  std::int64_t strokes = 0;      // pictures with lines, arrows or dots
  std::int64_t overlays = 0;     // pictures with letters or a HUD
};

class Renderer {
 public:
  explicit Renderer(
      const RendererOptions& options);  // throws std::runtime_error when OSMesa gives no context
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // The same Picture gives the same bytes in every Renderer of the same options.
  const Image& draw(const Picture& picture);
  // Of moments evenly spread over the time that a shutter is open, what moved is blurred; letters
  // are those of the first.
  const Image& draw(std::span<const Picture> moments);

  struct Info {
    std::string vendor, renderer, version;
  };
  Info info() const;
  const DrawCounts& counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
