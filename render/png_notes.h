// The chunks of a PNG that hold what it tells of itself.
#pragma once

#include <string>

#include "render/png.h"

namespace render {

// pHYs, then tEXt or, where a text is not plain ASCII, iTXt: as they stand between IHDR and IDAT of
// a picture `width` pixels wide. Throws std::invalid_argument for a keyword that is none.
std::string noteChunks(const PngNotes& notes, int width);

}  // namespace render
