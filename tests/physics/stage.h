// Worlds of boxes and chains for the tests of what a step leaves out.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "physics/make/chain.h"
#include "physics/world.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {

inline Settings grounded() {
  Settings settings = sweeps(100);
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  return settings;
}
inline Settings sleeping() {
  Settings settings = grounded();
  settings.sleep = SleepSettings{};
  return settings;
}

inline BodyId addGround(World& world) {
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  return world.add(ground);
}

inline BodyId addBody(World& world, const Shape& shape, const Vec3& x, double mass = 1,
                      Motion motion = Motion::kDynamic) {
  BodyDef def;
  def.shape = shape;
  def.pose.x = x;
  def.mass = mass;
  def.motion = motion;
  return world.add(def);
}

// Unit boxes on one another from the ground up; the first one's id.
inline BodyId addStack(World& world, int count, double x = 0) {
  BodyId first = 0;
  for (int k = 0; k < count; ++k) {
    const BodyId id = addBody(world, Box{Vec3(1, 1, 1)}, Vec3(x, k + 0.5, 0));
    if (k == 0) first = id;
  }
  return first;
}

inline StepReport run(World& world, int steps) {
  StepReport report;
  for (int k = 0; k < steps; ++k) report = world.step();
  return report;
}

inline void expectSameBytes(const World& p, BodyId i, const World& q, BodyId j) {
  const Pose &a = p.bodies().pose[i], &b = q.bodies().pose[j];
  EXPECT_EQ(std::memcmp(a.x.data(), b.x.data(), 3 * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(a.q.coeffs().data(), b.q.coeffs().data(), 4 * sizeof(double)), 0);
}

inline double furthest(const World& p, const World& q) {
  double most = 0;
  for (BodyId i = 0; i < p.bodyCount(); ++i) {
    most = std::max(most, (p.bodies().pose[i].x - q.bodies().pose[i].x).norm());
  }
  return most;
}

}  // namespace physics::testing
