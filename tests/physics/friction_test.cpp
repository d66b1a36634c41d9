// Coulomb friction of whole worlds against closed forms.
#include "tests/physics/slope.h"

namespace physics::testing {
namespace {

class Slope : public ::testing::TestWithParam<double> {};  // degrees
INSTANTIATE_TEST_SUITE_P(Friction, Slope, ::testing::Values(10.0, 20.0, 35.0));

TEST_P(Slope, HoldsABlockAtNinetyNineHundredthsOfTheLimit) {
  const double slope = GetParam() * kDegree, nu = std::tan(slope) / 0.99;
  World world = slopeOf(slope, {nu, nu});
  world.add(box({0.6, 0.1, 0.5}));
  runFor(world, 1);  // the first sweeps find the multipliers
  const double before = place(world).x();
  EXPECT_LT(std::abs(before), 2e-4);
  runFor(world, 9);
  EXPECT_LT(std::abs(place(world).x() - before), 1e-6);
}

TEST_P(Slope, LetsABlockSlideAtHundredAndOneHundredths) {
  const double slope = GetParam() * kDegree, nu = std::tan(slope) / 1.01;
  World world = slopeOf(slope, {nu, nu / 2});
  world.add(box({0.6, 0.1, 0.5}));
  runFor(world, 1);
  const double before = speed(world).x();
  runFor(world, 1);
  const double expected = kGravity * (std::sin(slope) - nu / 2 * std::cos(slope));
  EXPECT_NEAR(speed(world).x() - before, expected, 1e-3);
}

// NOTES 3.6: the deficit is v0 h/2; within the last step it may stop anywhere, mu g h^2.
TEST(Friction, StopsASlidingBlockWhereItShould) {
  for (const int substeps : {1, 4}) {
    World world = slopeOf(0, {0.5, 0.5}, substeps);
    world.add(box({0.6, 0.1, 0.5}, 3));
    runFor(world, 3);
    const double h = 1.0 / 60 / substeps;
    EXPECT_NEAR(place(world).x(), 9 / (kGravity)-3 * h / 2, 0.5 * kGravity * h * h) << substeps;
    EXPECT_LT(speed(world).norm(), 1e-9);
  }
}

TEST(Friction, OpposesTheSlipAtEveryPointOfAFace) {
  World world = slopeOf(0, {0.5, 0.5});
  world.add(box({0.6, 0.1, 0.5}, 3));
  runFor(world, 0.3);
  ASSERT_EQ(world.contacts().size(), 4u);
  for (const ContactReport& contact : world.contacts()) {
    EXPECT_LT(std::abs(contact.impulse.z()), 0.01 * std::abs(contact.impulse.x()));
    EXPECT_NEAR(std::abs(contact.impulse.x() / contact.impulse.y()), 0.5, 0.001);
  }
}

// v = 5/7 v0 from t = 2 v0/(7 mu g) = .728 s on.
// Matter on the rim of a rolling sphere comes R sin(w h) back: v/(w R) = 1 - (w h)^2/6 = 1
// - 4.1e-4.
TEST(Friction, TakesASphereFromSlippingToRollingAtFiveSevenths) {
  World world = slopeOf(0, {0.2, 0.2});
  world.add(ball(0.3, 5));
  runFor(world, 2);
  EXPECT_NEAR(speed(world).x(), 5.0 / 7 * 5, 1e-3 * 5);
  EXPECT_NEAR(-world.bodies().velocity[kBody].w.z() * 0.3, speed(world).x(), 5e-4 * 3.6);
}

TEST(Friction, LetsASphereStartToRollWhenItShould) {
  World world = slopeOf(0, {0.2, 0.2});
  world.add(ball(0.3, 5));
  runFor(world, 0.7);
  EXPECT_GT(speed(world).x() + world.bodies().velocity[kBody].w.z() * 0.3, 0.05);
  runFor(world, 0.05);
  EXPECT_LT(std::abs(speed(world).x() + world.bodies().velocity[kBody].w.z() * 0.3), 2e-3);
}

TEST(Friction, WithoutItASphereSlidesOnWithoutTurning) {
  World world = slopeOf(0, {0, 0});
  world.add(ball(0.3, 5));
  runFor(world, 1);
  EXPECT_NEAR(speed(world).x(), 5, 1e-12);
  EXPECT_LT(world.bodies().velocity[kBody].w.norm(), 1e-12);
}

TEST(Friction, LetsASphereRollDownASlopeAtFiveSeventhsOfASlide) {
  World world = slopeOf(20 * kDegree, {0.5, 0.5});
  world.add(ball(0.3, 0));
  runFor(world, 2);
  EXPECT_NEAR(speed(world).x(), 5.0 / 7 * kGravity * std::sin(20 * kDegree) * 2, 1e-3 * 5);
}

}  // namespace
}  // namespace physics::testing
