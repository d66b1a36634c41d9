// Points by the default method, and what rolls.
#include <gtest/gtest.h>

#include "physics/make/cloth.h"
#include "physics/make/rope.h"
#include "physics/make/soft_body.h"
#include "physics/world/measure.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

Settings byDefault(bool touches) {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  if (touches) settings.contact = ContactSettings{};
  return settings;
}

double kineticOf(const World& world, BodyId i) {
  const Bodies& b = world.bodies();
  const Vec3 w = b.pose[i].q.conjugate() * b.velocity[i].w;
  return 0.5 * b.mass[i] * b.velocity[i].v.squaredNorm() +
         0.5 * w.dot(b.inertia[i].cwiseProduct(w));
}

double totalEnergyOf(const World& world) {
  double energy = 0;
  for (BodyId i = 1; i < world.bodies().size(); ++i) {
    if (world.bodies().motion[i] != Motion::kDynamic) continue;
    energy += kineticOf(world, i) + 9.81 * world.bodies().mass[i] * world.bodies().pose[i].x.y();
  }
  return energy;
}

// A thousand times the mass of a node swings at the end: links stay as long as they are.
TEST(SmallStepsRope, HoldsAHeavyBallAndGainsNothing) {
  World world(byDefault(false));
  const BodyId ball = addBody(world, Sphere{0.25}, Vec3(2.95, 0, 0), 20);
  RopeDef rope;
  rope.to = Vec3(2.7, 0, 0);
  rope.count = 60;
  rope.matter.mass = 1;
  rope.pins = RopePins::kStart;
  rope.attach = RopeAttachments{std::nullopt, BodyRef{ball}};
  const std::vector<BodyId> nodes = add(world, rope);
  const double link = 2.7 / 59, start = totalEnergyOf(world);
  double longest = 0, most = start;
  for (int step = 0; step < 240; ++step) {
    world.step();
    most = std::max(most, totalEnergyOf(world));
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const Vec3 apart = world.bodies().pose[nodes[k]].x - world.bodies().pose[nodes[k - 1]].x;
      longest = std::max(longest, apart.norm());
    }
  }
  EXPECT_LT(longest, link + 1e-6);
  EXPECT_LT(most, start + 1e-3);
  EXPECT_LT(world.bodies().pose[ball].x.norm(), 2.95 + 1e-3);
}

// The ball swings down, the rope meets a peg at 7 m/s and winds itself around it.
TEST(SmallStepsRope, WrapsAroundAPegUnderAHeavyBallAndGainsNothing) {
  World world(byDefault(true));
  addBody(world, Box{Vec3(0.24, 0.24, 1.2)}, Vec3(0, -1.8, 0), 1, Motion::kStatic);
  const BodyId ball = addBody(world, Sphere{0.25}, Vec3(2.95, 0, 0), 20);
  RopeDef rope;
  rope.to = Vec3(2.7, 0, 0);
  rope.count = 60;
  rope.radius = 0.025;
  rope.matter.mass = 1;
  rope.pins = RopePins::kStart;
  rope.attach = RopeAttachments{std::nullopt, BodyRef{ball}};
  const std::vector<BodyId> nodes = add(world, rope);
  double longest = 0, before = 0;
  for (int step = 0; step < 150; ++step) {
    world.step();
    const double energy = totalEnergyOf(world);
    if (step > 0) {
      EXPECT_LT(energy, before + 0.2) << step;  // of 820 J
    }
    before = energy;
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const Vec3 apart = world.bodies().pose[nodes[k]].x - world.bodies().pose[nodes[k - 1]].x;
      longest = std::max(longest, apart.norm());
    }
  }
  EXPECT_LT(longest, 2.7 / 59 + 1e-6);
  EXPECT_LT((world.bodies().pose[ball].x - Vec3(0, -1.8, 0)).norm(), 1.3);
}

// A rope that swings against a wall, and a box that falls on the ground far away.
TEST(SmallStepsRope, KnowsNothingOfWhatFallsElsewhere) {
  const auto run = [](bool falls) {
    World world(byDefault(true));
    addBody(world, Box{Vec3(0.4, 4, 4)}, Vec3(0, 0, 0), 1, Motion::kStatic);
    addBody(world, Box{Vec3(4, 1, 4)}, Vec3(100, 0, 0), 1, Motion::kStatic);
    const BodyId ball = addBody(world, Sphere{0.2}, Vec3(2.2, 1, 0), 5);
    RopeDef rope;
    rope.from = Vec3(1, 1, 0);
    rope.to = Vec3(2, 1, 0);
    rope.count = 12;
    rope.matter.mass = 0.5;
    rope.pins = RopePins::kStart;
    rope.attach = RopeAttachments{std::nullopt, BodyRef{ball}};
    add(world, rope);
    const BodyId box = addBody(world, Box{Vec3(1, 1, 1)}, Vec3(100, falls ? 2 : 50, 0), 10);
    for (int step = 0; step < 120; ++step) world.step();
    std::vector<Pose> poses(world.bodies().pose.begin(), world.bodies().pose.begin() + box);
    return poses;
  };
  const std::vector<Pose> alone = run(false), beside = run(true);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].x, beside[i].x) << i;
    EXPECT_EQ(alone[i].q.coeffs(), beside[i].q.coeffs()) << i;
  }
}

ClothDef sheetOf(int nodes, const Vec3& v) {
  ClothDef cloth;
  cloth.u = Vec3::UnitX();
  cloth.v = v;
  cloth.nodes = {nodes, nodes};
  cloth.matter.mass = 0.4;
  return cloth;
}

// How much longer than at the start the longest link is, relative to it.
double strainOf(const World& world, const SoftParts& parts, int nodes) {
  const double length = 1.0 / (nodes - 1);
  double most = 0;
  for (int k = 1; k < nodes * nodes; ++k) {
    if (k % nodes == 0) continue;
    const auto& pose = world.bodies().pose;
    const Vec3 apart = pose[parts.nodes[k]].x - pose[parts.nodes[k - 1]].x;
    most = std::max(most, std::abs(apart.norm() / length - 1));
  }
  return most;
}

// 1 m wide between corners 1 m apart: it can neither sag nor stretch.
TEST(SmallStepsCloth, HangsStillInStrongGravity) {
  Settings settings = byDefault(false);
  settings.gravity = Vec3(0, -100, 0);
  World world(settings);
  ClothDef cloth = sheetOf(12, -Vec3::UnitY());
  cloth.pins = ClothPins::kTwoCorners;
  const SoftParts parts = add(world, cloth);
  for (int step = 0; step < 180; ++step) world.step();
  double kinetic = 0;
  for (const BodyId node : parts.nodes) {
    if (world.bodies().motion[node] == Motion::kDynamic) kinetic += kineticOf(world, node);
  }
  EXPECT_LT(kinetic, 1e-12);
  EXPECT_LT(strainOf(world, parts, 12), 1e-3);
}

// A hammock between four corners that starts crumpled a little. Swept, it trembles and gains
// energy.
TEST(SmallStepsCloth, ComesToRestBetweenFourCorners) {
  World world(byDefault(false));
  ClothDef cloth = sheetOf(16, Vec3::UnitZ());
  cloth.pins = ClothPins::kFourCorners;
  cloth.scatter = 0.02;
  const SoftParts parts = add(world, cloth);
  for (int step = 0; step < 120; ++step) world.step();
  const double settled = totalEnergyOf(world);
  double most = settled;
  for (int step = 0; step < 120; ++step) {
    world.step();
    most = std::max(most, totalEnergyOf(world));
  }
  EXPECT_LT(most - settled, 1e-3);
  EXPECT_LT(strainOf(world, parts, 16), 1e-3);
}

// Nothing holds all links of a cloth whose corners are pulled further apart than it is wide. It
// goes where it is pulled: links and attachments along the way share what is too long.
TEST(SmallStepsCloth, PulledLongerThanItIsItsLinksShareIt) {
  World world(byDefault(false));
  BodyDef hand;
  hand.shape = Sphere{0.03};
  hand.pose.x = Vec3(-0.5, 0, 0);
  hand.motion = Motion::kStatic;
  const BodyId left = world.add(hand);
  hand.pose.x = Vec3(0.5, 0, 0);
  hand.motion = Motion::kKinematic;
  hand.velocity.v = Vec3(0.3, 0, 0);
  const BodyId right = world.add(hand);
  ClothDef cloth = sheetOf(20, -Vec3::UnitY());
  cloth.position = Vec3(0, -0.5, 0);
  cloth.attach = {{{0, 0}, {left}}, {{19, 0}, {right}}};
  const SoftParts parts = add(world, cloth);
  for (int step = 0; step < 60; ++step) world.step();
  for (const BodyId node : parts.nodes) {
    EXPECT_LT((world.bodies().pose[node].x - cloth.position).norm(), 2) << node;
  }
  const double share = 0.3 / 20;  // 19 links, and half of one at each end
  const Vec3 open = world.bodies().pose[parts.nodes[19]].x - world.bodies().pose[right].x;
  EXPECT_LT(open.norm(), share);
  EXPECT_LT(strainOf(world, parts, 20) / 19, 1.2 * share);
}

// What has left the ground falls back to it, and not onto where it was looked for before.
TEST(SmallStepsRope, ThrownUpFromTheGroundItFliesAlongTheParabola) {
  World world(byDefault(true));
  addGround(world);
  RopeDef rope;
  rope.from = Vec3(0, 0.02, 0);
  rope.to = Vec3(0.2, 0.02, 0);
  rope.count = 2;
  rope.matter.mass = 1;
  const std::vector<BodyId> nodes = add(world, rope);
  run(world, 10);
  for (const BodyId node : nodes) world.setVelocity(node, {Vec3(0, 3, 0), Vec3::Zero()});
  run(world, 30);
  EXPECT_TRUE(world.contacts().empty());
  const double flown = 0.5, height = 0.02 + 3 * flown - 0.5 * 9.81 * flown * flown;
  for (const BodyId node : nodes) {
    // Of first order in substeps of 1/240 s: g h t/2 = 0.01 m.
    EXPECT_NEAR(world.bodies().pose[node].x.y(), height, 0.015);
  }
}

// Six edges and a volume repeat each other: what they share must not move it as a whole, nor the
// body that it meets.
TEST(SmallStepsMesh, ATetrahedronThatMeetsABodyKeepsTheirMomentum) {
  Settings settings = byDefault(true);
  settings.gravity.reset();
  World world(settings);
  const BodyId box = addBody(world, Box{Vec3(2, 0.2, 2)}, Vec3(0, -0.5, 0), 3);
  SoftBodyDef def;
  def.mesh = TetMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  def.edge = EdgeMatter{Edges::kLinks};
  def.matter.mass = 4;
  def.velocity.v = Vec3(0.1, -1, 0);
  add(world, def);
  const Vec3 before = measure(world).linearMomentum;
  double most = 0;
  for (int step = 0; step < 60; ++step) {
    world.step();
    most = std::max(most, (measure(world).linearMomentum - before).norm());
  }
  EXPECT_LT(most, 1e-12 * before.norm());
  EXPECT_LT(world.bodies().velocity[box].v.y(), -0.1);
}

// Contacts of what rolls are those of the pose that it has.
TEST(SmallStepsContacts, ABallThatRollsKeepsItsSpeed) {
  World world(byDefault(true));
  addGround(world);
  const BodyId ball = addBody(world, Sphere{0.5}, Vec3(0, 0.5, 0), 500);
  world.setVelocity(ball, {Vec3(0, 0, -1), Vec3(-2, 0, 0)});
  const double start = kineticOf(world, ball);
  run(world, 300);
  EXPECT_NEAR(kineticOf(world, ball), start, 1e-3 * start);  // with stale points: 3 % more
}

double meanHeightOf(const World& world, const SoftParts& parts) {
  double sum = 0;
  for (const BodyId i : parts.nodes) sum += world.bodies().pose[i].x.y();
  return sum / static_cast<double>(parts.nodes.size());
}

// By the default it is 5 mm behind after half a second.
TEST(SmallStepsMesh, ByAnAccuracyASoftBoxFallsAlongTheParabola) {
  Settings settings = byDefault(false);
  settings.accuracy = 1e-3;
  World world(settings);
  SoftBodyDef box;
  box.box = TetBox{Vec3(1, 0.5, 0.25), {3, 2, 2}};
  const SoftParts parts = add(world, box);
  const double from = meanHeightOf(world, parts);
  for (int step = 0; step < 30; ++step) {
    EXPECT_LT(world.step().accuracy.estimate, 1e-5) << step;  // a hundredth of it
  }
  EXPECT_NEAR(meanHeightOf(world, parts), from - 0.5 * 9.81 * 0.25, 1e-9);
}

// It swings from two corners in strong gravity. What its links are off by is no error that rows
// differ by: each of them is closed as far as is asked. What no step resolves is told.
TEST(SmallStepsCloth, ByAnAccuracyItsLinksAreCloserAndItsErrorIsTold) {
  const auto strainAfter = [](std::optional<double> accuracy) {
    Settings settings = byDefault(false);
    settings.gravity = Vec3(0, -100, 0);
    settings.accuracy = accuracy;
    settings.dt = 1.0 / 20;
    World world(settings);
    ClothDef cloth = sheetOf(12, Vec3::UnitZ());
    cloth.pins = ClothPins::kTwoCorners;
    const SoftParts parts = add(world, cloth);
    double most = 0, told = 0;
    for (int step = 0; step < 20; ++step) {
      told = std::max(told, world.step().accuracy.estimate);
      most = std::max(most, strainOf(world, parts, 12));
    }
    EXPECT_EQ(told > 0, accuracy.has_value());
    return most;
  };
  const double byItself = strainAfter(std::nullopt), asked = strainAfter(1e-3);
  EXPECT_LT(asked, 1e-3);
  EXPECT_LT(asked, 0.5 * byItself);
}

}  // namespace
}  // namespace physics::testing
