// Skeletons and poses from assets/, TOML files of their own.
#pragma once

#include "physics/make/ragdoll.h"
#include "scenes/read/table_reader.h"

namespace scenes {

// `value` is the name in the scene file: beside it as NAME.toml, else in assets/skeletons or
// assets/poses.
physics::Skeleton readSkeleton(const Value& value, const Spot& spot);
physics::JointTurns readTurns(const Value& value, const Spot& spot,
                              const physics::Skeleton& skeleton);

}  // namespace scenes
