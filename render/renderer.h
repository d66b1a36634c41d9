// Picture in, Image out. Owns an OSMesa context; one Renderer per thread, any number of them.
#pragma once

#include <memory>
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

class Renderer {
 public:
  explicit Renderer(
      const RendererOptions& options);  // throws std::runtime_error when OSMesa gives no context
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // The same Picture gives the same bytes in every Renderer of the same options.
  const Image& draw(const Picture& picture);

  struct Info {
    std::string vendor, renderer, version;
  };
  Info info() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
