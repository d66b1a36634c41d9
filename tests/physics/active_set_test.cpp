// Bounds on one side in the direct method.
#include <gtest/gtest.h>

#include "physics/constraints/link.h"
#include "physics/constraints/twist_limit.h"
#include "physics/world.h"
#include "physics/world/measure.h"

namespace physics {
namespace {

Settings directSettings(Stepping stepping) {
  Settings settings;
  settings.substeps = 1;
  settings.iterations = 20;
  settings.method = Method::kDirect;
  settings.stepping = stepping;
  settings.gravity = Vec3(0, -9.81, 0);
  return settings;
}

BodyId addPoint(World& world, const Vec3& x, double mass) {
  BodyDef def;
  def.shape = PointShape{};
  def.mass = mass;
  def.pose.x = x;
  return world.add(def);
}

BodyId addPin(World& world, const Vec3& x) {
  BodyDef def;
  def.shape = PointShape{};
  def.motion = Motion::kStatic;
  def.pose.x = x;
  return world.add(def);
}

// `count` nodes of 1 kg hang level from a pin, the last of them `load` times as heavy.
std::vector<BodyId> addRope(World& world, int count, double load) {
  std::vector<BodyId> nodes{addPin(world, Vec3::Zero())};
  for (int i = 1; i <= count; ++i) {
    nodes.push_back(addPoint(world, Vec3(0.1 * i, 0, 0), i == count ? load : 1));
    LinkDef link;
    link.bodies = {nodes[i - 1], nodes[i]};
    link.rope = true;
    world.add(link);
  }
  return nodes;
}

double longestLink(const World& world, const std::vector<BodyId>& nodes) {
  double longest = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const auto& pose = world.bodies().pose;
    longest = std::max(longest, (pose[nodes[i]].x - pose[nodes[i - 1]].x).norm());
  }
  return longest;
}

class DirectRope : public ::testing::TestWithParam<Stepping> {};

TEST_P(DirectRope, HoldsAThousandTimesANodeAtOneStepPerFrame) {
  World world(directSettings(GetParam()));
  const std::vector<BodyId> nodes = addRope(world, 20, 1000);
  double longest = 0;
  for (int k = 0; k < 120; ++k) {
    ASSERT_FALSE(world.step().notFinite);
    longest = std::max(longest, longestLink(world, nodes));
  }
  EXPECT_LT(longest, 0.1 + 1e-4);  // 0.1 %, measured 9e-6 m; sweeps alone leave .5 m
}

TEST_P(DirectRope, DoesNotPush) {
  World world(directSettings(GetParam()));
  const BodyId pin = addPin(world, Vec3::Zero());
  const BodyId ball = addPoint(world, Vec3(0, 0.05, 0), 1);  // above the pin, slack below 0.1 m
  LinkDef link;
  link.bodies = {pin, ball};
  link.length = 0.1;
  link.rope = true;
  world.add(link);
  for (int k = 0; k < 6; ++k) ASSERT_FALSE(world.step().notFinite);
  const double t = 0.1, h = 1.0 / 60;
  // Free fall, by backward Euler h/2 later; after .1 s it is still within reach.
  const double fallen = 0.5 * 9.81 * t * (t + (GetParam() == Stepping::kPaper ? h : 0));
  EXPECT_NEAR(world.bodies().pose[ball].x.y(), 0.05 - fallen, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Steppings, DirectRope,
                         ::testing::Values(Stepping::kPaper, Stepping::kBdf2));

// A rod that spins about its axis runs into a limit of .5 rad against the world.
TEST(DirectLimit, StopsASpinAndLetsItGoBack) {
  Settings settings = directSettings(Stepping::kPaper);
  settings.gravity.reset();
  World world(settings);
  BodyDef def;
  def.shape = Box{Vec3(1, 0.1, 0.1)};
  def.mass = 1;
  def.velocity.w = Vec3(6, 0, 0);
  const BodyId rod = world.add(def);
  TwistLimitDef limit;
  limit.bodies = {kWorldBody, rod};
  limit.range = {-0.5, 0.5};
  world.add(limit);
  for (int k = 0; k < 30; ++k) ASSERT_FALSE(world.step().notFinite);
  const auto turned = [&] { return 2 * std::asin(world.bodies().pose[rod].q.x()); };
  EXPECT_NEAR(turned(), 0.5, 1e-9);
  EXPECT_NEAR(world.bodies().velocity[rod].w.norm(), 0, 1e-9);
  world.setVelocity(rod, {Vec3::Zero(), Vec3(-1, 0, 0)});
  for (int k = 0; k < 6; ++k) ASSERT_FALSE(world.step().notFinite);
  EXPECT_NEAR(turned(), 0.4, 1e-9);  // nothing holds it back
}

}  // namespace
}  // namespace physics
