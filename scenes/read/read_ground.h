// { triangles = { mesh } } and { heights = { size, ... } }: ground of triangles.
#pragma once

#include "scenes/read/table_reader.h"

namespace scenes {

physics::Triangles readTriangles(TableReader& reader);
physics::Triangles readHeights(TableReader& reader);

}  // namespace scenes
