// What a World keeps from step to step.
#pragma once

#include "physics/constraints/archive.h"
#include "physics/kinematics/archive.h"
#include "physics/state/world_state.h"

namespace physics {

inline void archive(Archive& a, Load& load) {
  auto& [force, torque] = load;
  a(force, torque);
}

inline void archive(Archive& a, Sleep& sleep) {
  auto& [still, asleep, island, called, contacts, count] = sleep;
  a(still, asleep, island, called, contacts, count);
}

inline void archive(Archive& a, Allowed& allowed) {
  auto& [bdf2, symmetric] = allowed;
  a(bdf2, symmetric);
}

// The last two are scratch.
inline void archive(Archive& a, Stepper& stepper) {
  auto& [island, allowed, smooth, parted, unresolved, bounded, tried, ratio] = stepper;
  a(island, allowed, smooth, parted, unresolved, bounded);
}

// Groups are made in every step.
inline void archive(Archive& a, Local& local) {
  auto& [asked, wanted, substeps, last, calm, full, islands, groups, joins, start, end] = local;
  a(wanted, substeps, last, calm, full, islands, joins);
}

}  // namespace physics
