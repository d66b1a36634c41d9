// Wavefront OBJ files: vertices and faces.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "physics/base/types.h"
#include "scenes/read/read_value.h"

namespace scenes {

struct ObjMesh {
  std::vector<physics::Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;  // faces of more corners cut from their first
};

// The path of a mesh file, searched beside the scene file and then in assets/meshes.
std::string findMesh(const std::string& file, const Value& value, const Spot& spot);

// Throws InputError with the line of the file that is wrong.
ObjMesh readObj(const std::string& file, const Value& value, const Spot& spot);

}  // namespace scenes
