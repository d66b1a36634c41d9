// Parts of [[body]] that generators use as well.
#pragma once

#include "render/picture.h"
#include "scenes/table_reader.h"

namespace scenes {

// color = [r, g, b], "#rrggbb" or a hue's name.
void readColor(TableReader& reader, std::optional<render::Color>& color);

}  // namespace scenes
