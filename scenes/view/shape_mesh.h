// What is drawn of shapes that are no primitives.
#pragma once

#include "physics/bodies/shape.h"
#include "render/picture.h"

namespace scenes {

// Null for a primitive. A hull is flat from face to face, ground smooth but for its sharp edges.
std::shared_ptr<const render::Mesh> meshOf(const physics::Shape& shape);

// y of the lowest corner of ground at a pose [m].
double lowestOf(const physics::Triangles& ground, const physics::Pose& pose);

}  // namespace scenes
