// Bodies in parts of equal size that are near each other.
#include "physics/solver/bisection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace physics::testing {
namespace {

struct Cloud {
  std::vector<Pose> pose;
  std::vector<BodyId> bodies;
  Cloud(int count, const Vec3& size) : pose(count), bodies(count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> across(-0.5, 0.5);
    for (Pose& p : pose) {
      for (int k = 0; k < 3; ++k) p.x[k] = size[k] * across(random);
    }
    std::iota(bodies.begin(), bodies.end(), 0);
  }
};

TEST(Bisection, HasEveryBodyOnceInPartsOfEqualSize) {
  Cloud cloud(1003, Vec3(1, 2, 3));
  Workers workers;
  Bisection bisection;
  bisection.divide(cloud.pose, 3, cloud.bodies, workers);
  EXPECT_EQ(std::set<BodyId>(cloud.bodies.begin(), cloud.bodies.end()).size(), 1003U);
  std::vector<int> sizes(8, 0);
  for (std::size_t k = 0; k < cloud.bodies.size(); ++k) {
    if (k > 0) {
      EXPECT_GE(bisection.partOf(k), bisection.partOf(k - 1));
    }
    ++sizes[bisection.partOf(k)];
  }
  for (const int size : sizes) EXPECT_NEAR(size, 1003 / 8.0, 1);
}

TEST(Bisection, CutsAcrossWhereItIsTheWidest) {
  Cloud cloud(64, Vec3(1, 5, 2));
  Workers workers;
  Bisection bisection;
  bisection.divide(cloud.pose, 1, cloud.bodies, workers);
  double below = -1e9, above = 1e9;
  for (std::size_t k = 0; k < cloud.bodies.size(); ++k) {
    const double y = cloud.pose[cloud.bodies[k]].x.y();
    if (bisection.partOf(k) == 0) below = std::max(below, y);
    if (bisection.partOf(k) == 1) above = std::min(above, y);
  }
  EXPECT_LT(below, above);
}

// Of bodies in one place, too, and of fewer than there are parts.
TEST(Bisection, DependsOnNothingButPlacesAndNumbers) {
  for (const int count : {1, 3, 200}) {
    Cloud cloud(count, Vec3::Zero());
    std::vector<BodyId> turned(cloud.bodies.rbegin(), cloud.bodies.rend());
    Workers workers;
    Bisection bisection, other;
    bisection.divide(cloud.pose, 3, cloud.bodies, workers);
    other.divide(cloud.pose, 3, turned, workers);
    EXPECT_EQ(cloud.bodies, turned);
  }
}

}  // namespace
}  // namespace physics::testing
