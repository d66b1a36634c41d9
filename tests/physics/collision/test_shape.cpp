// Volumes, inertia and hulls.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "physics/bodies/hull.h"
#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using testing::Random;
constexpr double kPi = std::numbers::pi;

std::vector<Vec3> cubeCorners(double half) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
  }
  return points;
}

// Mean over the solid of (|p|^2 - p_i^2), by a grid of cells: inertia per mass without its
// formulas.
template <typename Inside>
MassProperties bySampling(const Inside& inside, double half, int cells) {
  const double step = 2 * half / cells;
  double count = 0;
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      for (int k = 0; k < cells; ++k) {
        const Vec3 p = Vec3::Constant(-half) + step * Vec3(i + .5, j + .5, k + .5);
        if (!inside(p)) continue;
        ++count;
        sum += Vec3::Constant(p.squaredNorm()) - Vec3(p.cwiseAbs2());
      }
    }
  }
  return {count * step * step * step, sum / count};
}

TEST(MassProperties, OfABoxAreTheTextbookOnes) {
  const MassProperties mass = massProperties(Box{Vec3(1, 2, 3)});
  EXPECT_DOUBLE_EQ(mass.volume, 6);
  EXPECT_NEAR((mass.inertiaPerMass - Vec3(13, 10, 5) / 12).norm(), 0, 1e-15);
}

TEST(MassProperties, OfASphereAreTheTextbookOnes) {
  const MassProperties mass = massProperties(Sphere{2});
  EXPECT_DOUBLE_EQ(mass.volume, 32 * kPi / 3);
  EXPECT_NEAR((mass.inertiaPerMass - Vec3::Constant(1.6)).norm(), 0, 1e-15);
}

TEST(MassProperties, OfACylinderAndACapsuleEqualSampledOnes) {
  const auto inCylinder = [](const Vec3& p) {
    return std::hypot(p.x(), p.z()) < .4 && std::abs(p.y()) < .7;
  };
  const auto inCapsule = [](const Vec3& p) {
    return (p - Vec3(0, std::clamp(p.y(), -.5, .5), 0)).norm() < .4;
  };
  const MassProperties pairs[2][2] = {
      {massProperties(Cylinder{.4, 1.4}), bySampling(inCylinder, .9, 180)},
      {massProperties(Capsule{.4, 1}), bySampling(inCapsule, .9, 180)}};
  for (const auto& [exact, sampled] : pairs) {  // cells of 1 cm: measured 2e-4
    EXPECT_NEAR(exact.volume, sampled.volume, 1e-3);
    EXPECT_NEAR((exact.inertiaPerMass - sampled.inertiaPerMass).norm(), 0, 1e-3);
  }
}

TEST(MassProperties, OfACapsuleWithoutLengthAreThoseOfASphere) {
  const MassProperties capsule = massProperties(Capsule{.3, 0}),
                       sphere = massProperties(Sphere{.3});
  EXPECT_DOUBLE_EQ(capsule.volume, sphere.volume);
  EXPECT_NEAR((capsule.inertiaPerMass - sphere.inertiaPerMass).norm(), 0, 1e-16);
}

TEST(MassProperties, OfPointAndPlaneAreZero) {
  EXPECT_EQ(massProperties(PointShape{}).volume, 0);
  EXPECT_EQ(massProperties(Plane{}).volume, 0);
}

TEST(MassProperties, RefuseSizesThatMakeNoSolid) {
  EXPECT_THROW(massProperties(Box{Vec3(1, 0, 1)}), std::invalid_argument);
  EXPECT_THROW(massProperties(Sphere{-1}), std::invalid_argument);
  EXPECT_THROW(massProperties(Cylinder{1, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(massProperties(Convex{}), std::invalid_argument);
}

TEST(MassProperties, BoundingRadiusHoldsTheFurthestPoint) {
  EXPECT_DOUBLE_EQ(boundingRadius(Box{Vec3(2, 2, 1)}), 1.5);
  EXPECT_DOUBLE_EQ(boundingRadius(Capsule{.25, 1}), .75);
  EXPECT_DOUBLE_EQ(boundingRadius(Cylinder{3, 8}), 5);
  EXPECT_EQ(boundingRadius(Plane{}), std::numeric_limits<double>::infinity());
}

TEST(Hull, OfACubeWithExtraPointsIsTheCube) {
  std::vector<Vec3> points = cubeCorners(.5);
  points.insert(points.end(), {Vec3(0, 0, 0), Vec3(.5, .1, .1), Vec3(.5, .5, .1), Vec3(0, 0, .5)});
  const PrincipalHull made = makeHull(points);
  EXPECT_EQ(made.hull->vertices.size(), 8u);
  EXPECT_EQ(made.hull->faces.size(), 6u);
  EXPECT_EQ(made.hull->edges.size(), 12u);
  EXPECT_TRUE(made.toPoints.q.isApprox(Quat::Identity(), 0));
}

TEST(Hull, HasTheMassOfTheBoxItIs) {
  std::vector<Vec3> points = cubeCorners(.5);
  for (Vec3& p : points) p = Vec3(1 * p.x() + 7, 2 * p.y(), 3 * p.z() - 4);
  const PrincipalHull made = makeHull(points);
  const MassProperties mass = massProperties(Convex{made.hull}),
                       box = massProperties(Box{Vec3(1, 2, 3)});
  EXPECT_NEAR(mass.volume, box.volume, 1e-13);
  EXPECT_NEAR((mass.inertiaPerMass - box.inertiaPerMass).norm(), 0, 1e-14);
  EXPECT_NEAR((made.toPoints.x - Vec3(7, 0, -4)).norm(), 0, 1e-14);
}

TEST(Hull, TurnsToItsPrincipalAxesAndBack) {
  Random random(1);
  const Quat q = random.rotation();
  std::vector<Vec3> points = cubeCorners(.5);
  for (Vec3& p : points) p = q * Vec3(p.x(), 2 * p.y(), 3 * p.z()) + Vec3(1, 2, 3);
  const PrincipalHull made = makeHull(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 back = made.toPoints.x + made.toPoints.q * made.hull->vertices[i];
    EXPECT_NEAR((back - points[i]).norm(), 0, 1e-14);
  }
  Vec3 inertia = massProperties(Convex{made.hull}).inertiaPerMass;
  std::sort(inertia.data(), inertia.data() + 3);
  EXPECT_NEAR((inertia - Vec3(5, 10, 13) / 12).norm(), 0, 1e-14);
}

TEST(Hull, OfRandomPointsHoldsThemAllAndIsClosed) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Vec3> points;
    for (int i = 0; i < 30; ++i) points.push_back(random.pose(1).x);
    const PrincipalHull made = makeHull(points);
    const Hull& hull = *made.hull;
    EXPECT_EQ(hull.vertices.size() + hull.faces.size(), hull.edges.size() + 2);
    for (const Vec3& p : points) {
      const Vec3 local = made.toPoints.q.conjugate() * (p - made.toPoints.x);
      for (const Hull::Face& face : hull.faces)
        EXPECT_LE(face.normal.dot(local), face.offset + 1e-12);
    }
  }
}

// A dodecahedron from a file: turned, and in six digits, so that no five corners are in one plane.
TEST(Hull, OfPointsInSixDigitsHasTheFacesThatAreMeant) {
  const double golden = (1 + std::sqrt(5)) / 2;
  std::vector<Vec3> points = cubeCorners(1);
  for (int i = 0; i < 4; ++i) {
    const double u = (i & 1 ? 1 : -1) / golden, v = (i & 2 ? 1 : -1) * golden;
    points.insert(points.end(), {Vec3(0, u, v), Vec3(u, v, 0), Vec3(v, 0, u)});
  }
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Quat q = random.rotation();
    std::vector<Vec3> written;
    for (const Vec3& p : points) written.push_back((q * p * 1e6).array().round() / 1e6);
    const Hull hull = convexHull(written);
    EXPECT_EQ(hull.faces.size(), 12u);
    EXPECT_EQ(hull.vertices.size(), 20u);
    EXPECT_EQ(hull.edges.size(), 30u);
    for (const Hull::Face& face : hull.faces) EXPECT_EQ(face.vertices.size(), 5u);
  }
}

TEST(Hull, RefusesPointsWithoutVolume) {
  EXPECT_THROW(makeHull(std::vector<Vec3>(3, Vec3::Ones())), std::invalid_argument);
  EXPECT_THROW(makeHull(std::vector<Vec3>(8, Vec3::Ones())), std::invalid_argument);
  EXPECT_THROW(makeHull(std::vector<Vec3>(8, Vec3::Zero())), std::invalid_argument);
  const std::vector<Vec3> flat = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {.2, .7, 0}};
  EXPECT_THROW(makeHull(flat), std::invalid_argument);
  EXPECT_THROW(makeHull(std::vector<Vec3>(4, Vec3::Constant(std::nan("")))), std::invalid_argument);
}

}  // namespace
}  // namespace physics
