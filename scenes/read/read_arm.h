// [[arm]]: links, joints and limits in a row, and what the tip reaches for.
#pragma once

#include "physics/kinematics/arm_def.h"
#include "scenes/read/recipe.h"

namespace scenes {

// The keys of an arm that say what its links are: `links`, or `count` and `length` with one value
// of everything else for all of them.
void readLinks(TableReader& reader, physics::ArmDef& def);

void readArm(TableReader& reader, Recipe& recipe);

}  // namespace scenes
