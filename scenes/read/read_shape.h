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

// The path of a mesh file, searched beside the scene file and then in assets/meshes.
std::string findMesh(const std::string& file, const Value& value, const Spot& spot);

// The vertices of an OBJ file.
std::vector<physics::Vec3> readObjVertices(const std::string& file, const Value& value,
                                           const Spot& spot);

}  // namespace scenes
