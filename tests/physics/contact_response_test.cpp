// Contacts see the mass that joints put behind a body.
#include <gtest/gtest.h>

#include "physics/make/chain.h"
#include "physics/world.h"
#include "physics/world/measure.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

Settings withContacts(const Vec3& gravity) {
  Settings settings;
  settings.gravity = gravity;
  settings.contact = ContactSettings{};
  return settings;
}

// A bridge of planks of 31 kg, and a block that is set down on it.
class BlockOnBridge : public ::testing::TestWithParam<double> {};
TEST_P(BlockOnBridge, IsCarriedByPlanksThatItIsMuchHeavierThan) {
  World world(withContacts(Vec3(0, -9.81, 0)));
  BridgeDef bridge;
  bridge.from = {-3, 2, 0};
  bridge.to = {3, 2, 0};
  bridge.count = 16;
  bridge.sag = 0.35;
  bridge.width = 1.4;
  bridge.matter.density = 600;
  add(world, bridge);
  const BodyId block = addBody(world, Box{Vec3(0.8, 0.8, 0.8)}, Vec3(0, 2.2, 0), GetParam());
  run(world, 480);
  for (int k = 0; k < 120; ++k) {
    world.step();
    ASSERT_LT(world.largestOverlap(), 5e-3) << "step " << k;  // measured 2e-3 at most
    ASSERT_LT(world.bodies().velocity[block].v.norm(), 0.1);
  }
  EXPECT_GT(world.bodies().pose[block].x.y(), 1.9);
}
INSTANTIATE_TEST_SUITE_P(Masses, BlockOnBridge, ::testing::Values(100, 1000, 1e4));

// A closed belt of slats of 2 kg over two drums, two sockets from slat to slat, and boxes of 10 kg
// on it: a loop most of whose bodies are touched.
TEST(ContactResponse, OfABeltOverDrumsCarriesBoxes) {
  constexpr double kRound = 0.66, kSpan = 3;  // m: its turns about the drums, and between them
  constexpr int kSlats = 40;
  constexpr double kLength = 2 * kSpan + 2 * kPi * kRound;
  World world(withContacts(Vec3(0, -9.81, 0)));
  const auto add = [&](const Shape& shape, const Vec3& x, const Vec3& turn, double mass) {
    BodyDef def;
    def.shape = shape;
    def.pose = {x, exponential(turn)};
    def.mass = mass;
    def.motion = mass > 0 ? Motion::kDynamic : Motion::kStatic;
    def.friction = Friction{0.3, 0.3};
    return world.add(def);
  };
  for (const double side : {-1.0, 1.0}) {
    add(Capsule{0.58, 2.4}, Vec3(side * kSpan / 2, 2, 0), Vec3(kPi / 2, 0, 0), 0);
  }
  const auto poseAt = [&](double way) {  // where it is and its turn about z
    const double half = kLength / 2, along = std::fmod(way, half), side = way < half ? 1 : -1;
    if (along < kSpan) {
      const Vec3 x(side * (along - kSpan / 2), 2 + side * kRound, 0);
      return std::pair{x, side > 0 ? 0 : kPi};
    }
    const double angle = (along - kSpan) / kRound;
    const Vec3 out(side * std::sin(angle), side * std::cos(angle), 0);
    const Vec3 x = Vec3(side * kSpan / 2, 2, 0) + kRound * out;
    return std::pair{x, (side > 0 ? 0 : kPi) - angle};
  };
  std::vector<BodyId> slats;
  for (int k = 0; k < kSlats; ++k) {
    const auto [x, turn] = poseAt((k + 0.5) * kLength / kSlats);
    const Box slat{Vec3(0.84 * kLength / kSlats, 0.06, 1.6)};
    slats.push_back(add(slat, x, Vec3(0, 0, turn), 2));
  }
  for (int k = 0; k < kSlats; ++k) {
    const Vec3 x = poseAt(std::fmod((k + 1) * kLength / kSlats, kLength)).first;
    for (const double z : {-0.7, 0.7}) {
      BallSocketDef joint;
      joint.bodies = {slats[k], slats[(k + 1) % kSlats]};
      joint.at = x + Vec3(0, 0, z);
      world.add(joint);
    }
  }
  std::vector<BodyId> boxes;
  for (int k = 0; k < 5; ++k) {
    boxes.push_back(add(Box{Vec3(0.5, 0.5, 0.5)}, Vec3(0.6 * k - 1.2, 3.1, 0), Vec3::Zero(), 10));
  }
  const double before = measure(world).total();
  for (int k = 0; k < 300; ++k) {
    world.step();
    ASSERT_LE(measure(world).total(), before + 1e-6) << "step " << k;
    ASSERT_LT(world.largestOverlap(), 5e-3) << "step " << k;
  }
  EXPECT_LT(world.largestOverlap(), 1e-3);
  for (const BodyId box : boxes) EXPECT_GT(world.bodies().pose[box].x.y(), 2.2);
}

// Links of 1 kg, free in space, hit in the middle by a ball of 100 kg.
TEST(ContactResponse, KeepsMomentumAndGivesNoEnergy) {
  World world(withContacts(Vec3::Zero()));
  BodyId last = kWorldBody;
  for (int k = 0; k < 9; ++k) {
    const BodyId id = addBody(world, Box{Vec3(0.5, 0.2, 0.2)}, Vec3(0.5 * k, 0, 0), 1);
    if (k > 0) {
      BallSocketDef joint;
      joint.bodies = {last, id};
      joint.at = Vec3(0.5 * k - 0.25, 0, 0);
      world.add(joint);
    }
    last = id;
  }
  const BodyId ball = addBody(world, Sphere{0.3}, Vec3(2, 1, 0), 100);
  world.setVelocity(ball, {Vec3(0, -3, 0), Vec3::Zero()});
  const Vec3 before = measure(world).linearMomentum;
  double most = measure(world).kinetic;
  for (int k = 0; k < 120; ++k) {
    world.step();
    EXPECT_LT((measure(world).linearMomentum - before).norm(),
              1e-4 * before.norm());  // single precision
    const double now = measure(world).kinetic;
    EXPECT_LT(now, 1.0001 * most) << "step " << k;
    most = now;
  }
  EXPECT_LT(world.largestOverlap(), 1e-2);
}

}  // namespace
}  // namespace physics::testing
