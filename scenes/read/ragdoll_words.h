// What a figure of a scene file is made of, whatever tells it how to move.
#pragma once

#include "scenes/read/recipe.h"
#include "scenes/read/skeleton.h"

namespace scenes {

struct RagdollWords {
  physics::Skeleton skeleton;
  physics::JointTurns start;
  PoseScript script;  // without drives and root: those depend on the copy
  physics::RagdollDef def;
};

// `skeleton`, and what physics::RagdollDef asks for.
void readFigure(TableReader& reader, Recipe& recipe, RagdollWords& words);

// Its bones by their names, in the colours of a family, and its script.
void addFigure(TableReader& reader, Recipe& recipe, RagdollWords words, const std::string& name);

// What drives aim at, one per joint.
std::vector<physics::Quat> targetsOf(const physics::Skeleton& skeleton,
                                     const physics::JointTurns& turns);

}  // namespace scenes
