// Worlds of points at one step of 1/60 s, for tests of forces.
#pragma once

#include "physics/world.h"
#include "tests/physics/pair.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {

inline constexpr double kStep = 1.0 / 60;

inline Settings steps(int substeps, int iterations) {
  Settings settings = sweeps();
  settings.dt = kStep;
  settings.substeps = substeps;
  settings.iterations = iterations;
  return settings;
}

inline BodyDef point(double mass, const Vec3& x, const Vec3& v = Vec3::Zero()) {
  BodyDef def;
  def.mass = mass;
  def.pose.x = x;
  def.velocity.v = v;
  return def;
}

}  // namespace physics::testing
