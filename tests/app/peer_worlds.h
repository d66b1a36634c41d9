// Worlds that every engine can be asked for, and a peer that is stepped beside its World.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "app/peers/peer.h"
#include "physics/make/hinge.h"
#include "physics/make/prismatic.h"
#include "physics/make/universal.h"
#include "physics/world/measure.h"
#include "tests/physics/sweeps.h"

namespace tests {

constexpr double kGravity = 9.81;

inline physics::Settings falling() {
  physics::Settings settings = physics::testing::sweeps();
  settings.gravity = physics::Vec3(0, -kGravity, 0);
  return settings;
}

inline physics::Settings touching(double restitution = 0) {
  physics::Settings settings = falling();
  settings.contact = physics::ContactSettings{};
  settings.contact->restitution = restitution;
  return settings;
}

inline physics::BodyId addBody(physics::World& world, const physics::Shape& shape,
                               const physics::Vec3& x) {
  physics::BodyDef def;
  def.shape = shape;
  def.pose.x = x;
  return world.add(def);
}

inline void addGround(physics::World& world) {
  physics::BodyDef def;
  def.shape = physics::Plane{};
  def.motion = physics::Motion::kStatic;
  world.add(def);
}

constexpr double kBar = 1;  // m
inline physics::World makeBar() {
  physics::World world(falling());
  const physics::BodyId bar = addBody(world, physics::Box{{kBar, 0.1, 0.1}}, {kBar / 2, 0, 0});
  physics::HingeDef hinge;
  hinge.bodies = {physics::kWorldBody, bar};
  hinge.axis = {0, 0, 1};
  add(world, hinge);
  return world;
}

// A peer and the World that measures it.
struct PeerRun {
  physics::World world;
  app::PeerStart start;
  std::vector<physics::Pose> pose;
  std::vector<physics::Velocity> velocity;

  PeerRun(physics::World made, const std::string& method)
      : world(std::move(made)), start(app::startPeer(method, world)) {
    pose.resize(world.bodies().pose.size());
    velocity.resize(pose.size());
  }
  bool refused() const { return start.peer == nullptr; }
  bool read() {
    start.peer->read(pose, velocity);
    return world.setState(pose, velocity);
  }
  void steps(int count, double h) {
    for (int k = 0; k < count; ++k) start.peer->step(h);
    EXPECT_TRUE(read());
  }
  const physics::Bodies& bodies() const { return world.bodies(); }
};

class Peers : public testing::TestWithParam<std::string> {};

// One name that is skipped with the reason, where no engine was found.
inline std::vector<std::string> peerNames() {
  std::vector<std::string> names;
  for (const app::PeerMethod& method : app::peerMethods()) names.push_back(method.name);
  if (names.empty()) names.push_back("none");
  return names;
}

}  // namespace tests

// Ends a test with a message where the engine is missing or refuses the world.
#define SKIP_WHERE_ABSENT() \
  if (GetParam() == "none") GTEST_SKIP() << "neither libbullet-dev nor libode-dev was found"
#define SKIP_WHERE_REFUSED(run) \
  if ((run).refused()) GTEST_SKIP() << (run).start.refusal
