// [[body]], [[ragdoll]] and what is soft, and what generators share with them.
#pragma once

#include "render/picture.h"
#include "scenes/read/table_reader.h"

namespace scenes {

class Recipe;

void readBody(TableReader& reader, Recipe& recipe);
void readRagdoll(TableReader& reader, Recipe& recipe);
void readBvh(TableReader& reader, Recipe& recipe);
void readRope(TableReader& reader, Recipe& recipe);
void readCloth(TableReader& reader, Recipe& recipe);
void readSoftBody(TableReader& reader, Recipe& recipe);

// color = [r, g, b], "#rrggbb" or a hue's name; with a fourth part what shows through: [r, g, b, a]
// or "#rrggbbaa", where 1 and ff are opaque.
// Where a body or a part of one is: position, and quaternion or rotation.
physics::Pose readPose(TableReader& reader);

void readColor(TableReader& reader, std::optional<render::Color>& color);
// The same of one value, where "transparent" may be a colour too.
render::Color colorOf(const Value& value, const Spot& spot, bool orTransparent = false);

}  // namespace scenes
