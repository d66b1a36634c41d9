// The only file that includes OSMesa's header.
#include "render/context.h"

#include <GL/osmesa.h>

#include <stdexcept>

namespace render {

Context::Context() {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_STENCIL_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  handle_ = OSMesaCreateContextAttribs(attributes, nullptr);
  if (handle_ == nullptr)
    throw std::runtime_error("OSMesa gives no OpenGL 3.3 core context; is libosmesa6 installed?");
  try {
    makeCurrent();
  } catch (...) {
    OSMesaDestroyContext(static_cast<OSMesaContext>(handle_));
    throw;
  }
}

Context::~Context() { OSMesaDestroyContext(static_cast<OSMesaContext>(handle_)); }

void Context::makeCurrent() {
  if (OSMesaMakeCurrent(static_cast<OSMesaContext>(handle_), pixels_, GL_UNSIGNED_BYTE, 16, 16) !=
      GL_TRUE)
    throw std::runtime_error("OSMesa cannot make its context current");
}

}  // namespace render

#ifdef __SANITIZE_ADDRESS__
// OSMesaDestroyContext of Mesa 22.3 keeps about 200 bytes of each context.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa\n"; }
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif
