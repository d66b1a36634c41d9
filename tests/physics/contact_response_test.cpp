// Contacts see the mass that joints put behind a body.
#include <gtest/gtest.h>

#include "physics/make/chain.h"
#include "physics/world.h"
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
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (BodyId i = 1; i < world.bodies().size(); ++i) {
      sum += world.bodies().mass[i] * world.bodies().velocity[i].v;
    }
    return sum;
  };
  const auto motion = [&] {
    double sum = 0;
    for (BodyId i = 1; i < world.bodies().size(); ++i) {
      const Bodies& b = world.bodies();
      const Vec3 w = b.pose[i].q.conjugate() * b.velocity[i].w;
      sum += 0.5 * b.mass[i] * b.velocity[i].v.squaredNorm() +
             0.5 * w.dot(b.inertia[i].cwiseProduct(w));
    }
    return sum;
  };
  const Vec3 before = momentum();
  double most = motion();
  for (int k = 0; k < 120; ++k) {
    world.step();
    EXPECT_LT((momentum() - before).norm(), 1e-4 * before.norm());  // single precision
    const double now = motion();
    EXPECT_LT(now, 1.0001 * most) << "step " << k;
    most = now;
  }
  EXPECT_LT(world.largestOverlap(), 1e-2);
}

}  // namespace
}  // namespace physics::testing
