// One number for a Picture: equal pictures have it equal, on every machine.
#pragma once

#include <cstdint>

#include "render/picture.h"

namespace render {

// Over every value in the order of declaration, floats by their bits. Golden images keep it, to
// tell a changed view from a changed renderer.
std::uint64_t pictureHash(const Picture& picture);

}  // namespace render
