// A plane with gravity that leans, and what is put on it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "physics/world.h"
#include "tests/physics/gravity.h"
#include "tests/physics/pair.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {

// A plane y = 0 with gravity leaning by `slope` towards +x.
inline World slopeOf(double slope, Friction friction, int substeps = 4) {
  Settings settings = sweeps(128);  // a box on four points is solved to rounding
  settings.dt = 1.0 / 60;
  settings.substeps = substeps;
  settings.gravity = kGravity * Vec3(std::sin(slope), -std::cos(slope), 0);
  settings.contact = ContactSettings{};
  settings.contact->friction = friction;
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  return world;
}

constexpr BodyId kBody = 2;  // what the tests put on the plane

inline BodyDef box(const Vec3& size, double speed = 0) {
  BodyDef def;
  def.shape = Box{size};
  def.pose.x = Vec3(0, size.y() / 2, 0);
  def.velocity.v = Vec3(speed, 0, 0);
  return def;
}

inline BodyDef ball(double radius, double speed) {
  BodyDef def;
  def.shape = Sphere{radius};
  def.pose.x = Vec3(0, radius, 0);
  def.velocity.v = Vec3(speed, 0, 0);
  return def;
}

inline void runFor(World& world, double seconds) {
  const int steps = static_cast<int>(std::lround(seconds * 60));
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(world.step().notFinite);
}

inline Vec3 place(const World& world) { return world.bodies().pose[kBody].x; }
inline Vec3 speed(const World& world) { return world.bodies().velocity[kBody].v; }

}  // namespace physics::testing
