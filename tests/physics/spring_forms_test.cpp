// Springs in both forms, from no stiffness to the highest, and relaxed, (108)-(124).
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/physics/points.h"

namespace physics::testing {
namespace {

// (123) with the full matrix, at every iterate.
TEST(VectorSpring, EveryIterateIsThatOf123) {
  Random random(9);
  Bodies bodies = randomPair(random);
  displace(bodies.start[0], Vec3(0.02, 0.01, 0), Vec3(0.1, 0, 0.05));
  const VectorSpring item{{0, 1}, {Vec3(0.3, 0.1, 0), Vec3(0, -0.4, 0.2)}, 800, 3};
  const auto gap = [&](const std::vector<Pose>& pose) -> Vec3 {
    return (pose[0].x + pose[0].q * item.anchors[0]) - (pose[1].x + pose[1].q * item.anchors[1]);
  };
  Multipliers<VectorSpring> lambda;
  for (int k = 0; k < 6; ++k) {
    Response<VectorSpring> response;
    const Mat3 a = effectiveMassInverse(item, rowOf(item, bodies), bodies.inverse, response);
    const double alpha = 800 * kStep * kStep + 3 * kStep;
    const Vec3 speed = (gap(bodies.pose) - gap(bodies.start)) / kStep;
    const Vec3 right = alpha * (a * lambda.total) - 800 * kStep * kStep * gap(bodies.pose) -
                       3 * kStep * speed * kStep;
    const Vec3 expected = (Mat3::Identity() + alpha * a).inverse() * right;
    visit(item, lambda, bodies, kStep);
    EXPECT_LT((lambda.total - expected).norm(), 1e-14 * (1 + expected.norm())) << "iterate " << k;
  }
}

TEST(VectorSpring, ComesToRestOnItsAnchorThroughTheCentre) {
  World world(steps(4, 4));
  SpringDef def;
  def.bodies = {kWorldBody, world.add(point(1, Vec3(0.5, 0, 0)))};
  def.stiffness = 100;
  def.damping = 4;
  def.restLength = 0;
  world.add(def);
  double least = 1;
  for (int k = 0; k < 600; ++k) {
    world.step();
    least = std::min(least, world.bodies().pose[1].x.x());
  }
  EXPECT_LT(least, -0.05);  // it swings through, where a length would bounce
  EXPECT_LT(world.bodies().pose[1].x.norm(), 1e-6);
}

TEST(Spring, IsFiniteAndNeverGainsEnergyFromNoStiffnessToTheHighest) {
  for (double stiffness = 0; stiffness <= 1e12;
       stiffness = stiffness == 0 ? 1e-9 : 1e3 * stiffness) {
    for (const double rest : {0.0, 1.0}) {
      World world(steps(1, 4));
      SpringDef def;
      def.bodies = {kWorldBody, world.add(point(1, Vec3(1.2, 0, 0)))};
      def.stiffness = stiffness;
      def.restLength = rest;
      world.add(def);
      double last = world.springEnergy();
      for (int k = 0; k < 100; ++k) {
        world.step();
        const Vec3 v = world.bodies().velocity[1].v;
        const double energy = 0.5 * v.squaredNorm() + world.springEnergy();
        ASSERT_LE(energy, last * (1 + 1e-9) + 1e-12) << stiffness;
        last = energy;
      }
    }
  }
}

TEST(Force, RelaxedReachesTheSameEnd) {  // (124)
  const auto place = [](double relaxation) {
    World world(steps(1, 200));
    SpringDef def;
    def.tuning.relaxation = relaxation;
    def.stiffness = 400;
    def.restLength = 1;
    const BodyId a = world.add(point(1, Vec3(1.3, 0, 0))), b = world.add(point(2, Vec3(2.1, 0, 0)));
    def.bodies = {kWorldBody, a};
    world.add(def);
    def.bodies = {a, b};
    world.add(def);
    world.step();
    return world.bodies().pose[b].x.x();
  };
  EXPECT_NEAR(place(0.3), place(1), 1e-13);
  EXPECT_NEAR(place(1.5), place(1), 1e-13);
}

}  // namespace
}  // namespace physics::testing
