// An OSMesa context of its own: software OpenGL without a display.
#pragma once

#include <string>

namespace render {

class Context {
 public:
  Context();  // throws std::runtime_error when OSMesa gives no core profile 3.3; is current after
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void makeCurrent();  // on the calling thread

 private:
  void* handle_ = nullptr;
  unsigned char pixels_[4 * 16 * 16] = {};  // OSMesa wants a buffer; all drawing is in framebuffers
};

}  // namespace render
