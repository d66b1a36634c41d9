// Shapes of a scene file, and the meshes that convex ones are made from.
#pragma once

#include "scenes/read/table_reader.h"

namespace scenes {

// A shape in its body frame, and where that frame lies against the file's own: a convex shape is
// moved so that its centre of mass and principal axes are the frame's.
struct PlacedShape {
  physics::Shape shape;
  physics::Pose toFile;
};
PlacedShape readShape(const Value& value, const Spot& spot);
PlacedShape readShapeOf(TableReader& reader);  // from its key `shape`, which must be there

}  // namespace scenes
