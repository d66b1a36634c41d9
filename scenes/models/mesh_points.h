// Points of a mesh file, of which a hull is made.
#pragma once

#include <string>
#include <vector>

#include "physics/base/types.h"

namespace scenes {

std::string endingOf(const std::string& path);  // ".obj": in small letters

// The vertices of an OBJ or STL file, binary or text. Throws std::invalid_argument with what is
// wrong with it.
std::vector<physics::Vec3> meshPoints(const std::string& path);

// The corners of the hull of `points`, in their frame. Throws std::invalid_argument where they are
// fewer than four or lie in one plane.
std::vector<physics::Vec3> hullCorners(const std::vector<physics::Vec3>& points);

}  // namespace scenes
