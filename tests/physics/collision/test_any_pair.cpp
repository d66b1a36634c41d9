// What holds for every pair of shapes at random poses.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

constexpr double kSize = 0.5;  // of the shapes, roughly
constexpr double kFlat =
    1e-3 * kSize;  // neighbouring directions count as one: half of it, measured

struct Two {
  Named a, b;
};
void PrintTo(const Two& two, std::ostream* out) { *out << two.a.name << " " << two.b.name; }

std::vector<Two> pairs() {
  std::vector<Two> result;
  const std::vector<Named> all = shapes();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); ++j) {
      if (j == 0 || (i == j && i + 1 == all.size())) continue;  // two points, two planes
      result.push_back({all[i], all[j]});
    }
  }
  return result;
}

class AnyPair : public ::testing::TestWithParam<Two> {};
INSTANTIATE_TEST_SUITE_P(All, AnyPair, ::testing::ValuesIn(pairs()), [](const auto& info) {
  return info.param.a.name + "_" + info.param.b.name;
});

// Neither closed form nor all directions tried: the direction of overlap is searched for.
bool searched(const Two& two) {
  return two.a.name == "cylinder" || two.b.name == "cylinder" || two.a.name == "ball";
}

// Of a normal; curved sides are approached by steps that end when the distance is exact to 1e-14,
// and a direction is known to the root of that only: measured 1.4e-5 in samples of thirty seeds.
double directionTolerance(const Two& two) { return searched(two) ? 2e-5 : 1e-9; }

// Calls check(poses, manifold, world normal from b to a) for random poses with a manifold.
template <typename Check>
void forRandomPoses(const Two& two, int count, double margin, double furthest, const Check& check) {
  Random random(7);
  for (int i = 0; i < count; ++i) {
    std::vector<Pose> poses = {Pose{}, random.pose(furthest), random.pose(furthest)};
    if (std::holds_alternative<Plane>(two.b.shape)) poses[2].x *= 0.2;
    const auto found = meet(two.a.shape, poses[1], two.b.shape, poses[2], margin);
    if (found.empty()) continue;
    ASSERT_EQ(found.size(), 1u);
    ASSERT_GT(found[0].count, 0);
    const Vec3 n = poses[found[0].b].q * found[0].normal;
    ASSERT_NEAR(n.norm(), 1, 1e-12);
    check(poses, found[0], found[0].a == 1 ? n : Vec3(-n));
  }
}

// Inside of all of many half spaces that hold the shape.
bool isInside(const Shape& shape, const Pose& pose, const Vec3& p) {
  if (std::holds_alternative<Plane>(shape)) return true;
  static const std::vector<Vec3> directions = [] {
    Random random(11);
    std::vector<Vec3> result(300);
    for (Vec3& d : result) d = random.direction();
    return result;
  }();
  return std::all_of(directions.begin(), directions.end(), [&](const Vec3& d) {
    return d.dot(p) <= d.dot(supportOf(shape, pose, d)) + kFlat / 3;
  });
}

// Two points of the shapes can not be nearer than the distance, and no direction can separate them
// by more: when both agree they are the distance.
TEST_P(AnyPair, GapOfSeparatedShapesIsTheirDistance) {
  int separated = 0, exact = 0;
  forRandomPoses(
      GetParam(), 1500, 0.3, 0.8, [&](const auto& poses, const Manifold& m, const Vec3& n) {
        const double gap = smallestGap(m, poses);
        if (gap <= 0) return;
        const Two& two = GetParam();
        const double along = separation(two.a.shape, poses[1], two.b.shape, poses[2], n);
        EXPECT_NEAR(gap, along, kFlat);
        EXPECT_NEAR(distanceOf(two.a.shape, poses[1], two.b.shape, poses[2]), gap, kFlat);
        for (int i = 0; i < m.count; ++i) {
          const Point point = place(m, i, poses);
          EXPECT_TRUE(isInside(two.a.shape, poses[1], m.a == 1 ? point.onA : point.onB));
          EXPECT_TRUE(isInside(two.b.shape, poses[2], m.a == 1 ? point.onB : point.onA));
          if (point.gap > gap) continue;
          const Vec3 apart = point.onA - point.onB;  // side by side but for nearly parallel lines
          EXPECT_LE((apart - gap * point.n).norm(), 0.02 * kSize);
        }
        ++separated;
        if (std::abs(gap - along) < 1e-9) ++exact;
      });
  EXPECT_GT(separated, 40);
  EXPECT_GT(exact, separated * 95 / 100);
}

TEST_P(AnyPair, MovingApartByTheDepthSeparates) {
  const Two& two = GetParam();
  int overlapping = 0;
  forRandomPoses(two, 1500, 0, 0.4, [&](const auto& poses, const Manifold& m, const Vec3& n) {
    const double gap = smallestGap(m, poses);
    const double along = separation(two.a.shape, poses[1], two.b.shape, poses[2], n);
    EXPECT_LE(along, gap + 1e-9);  // the points are not deeper than the shapes
    const double depth = -distanceOf(two.a.shape, poses[1], two.b.shape, poses[2]);
    EXPECT_GE(along, -depth - kFlat);
    ++overlapping;
  });
  EXPECT_GT(overlapping, 50);
}

TEST_P(AnyPair, DepthIsNotMoreThanOfAnySampledDirection) {
  const Two& two = GetParam();
  if (std::holds_alternative<Plane>(two.b.shape)) return;  // one direction only
  Random random(5);
  std::vector<Vec3> directions(500);
  for (Vec3& d : directions) d = random.direction();
  forRandomPoses(two, 300, 0, 0.4, [&](const auto& poses, const Manifold&, const Vec3&) {
    double best = -1e300;
    for (const Vec3& d : directions) {
      best = std::max(best, separation(two.a.shape, poses[1], two.b.shape, poses[2], d));
    }
    const double depth = -distanceOf(two.a.shape, poses[1], two.b.shape, poses[2]);
    EXPECT_LE(depth, -best * (searched(two) ? 1.15 : 1) + 1e-9);  // 1.15: measured, deep ones only
  });
}

TEST_P(AnyPair, TurningTheSceneTurnsTheResult) {
  const Two& two = GetParam();
  Random random(9);
  forRandomPoses(two, 200, 0.05, 0.5, [&](const auto& poses, const Manifold& m, const Vec3& n) {
    const Quat q = random.rotation();
    std::vector<Pose> turned = poses;
    for (Pose& pose : turned) pose = {q * pose.x + Vec3(1, 2, 3), q * pose.q};
    const auto again = meet(two.a.shape, turned[1], two.b.shape, turned[2], 0.05);
    ASSERT_EQ(again.size(), 1u) << smallestGap(m, poses);
    ASSERT_EQ(again[0].count, m.count);
    for (int i = 0; i < m.count; ++i) {
      const Point before = place(m, i, poses), after = place(again[0], i, turned);
      const double tolerance = directionTolerance(two);
      EXPECT_NEAR((q * before.onA + Vec3(1, 2, 3) - after.onA).norm(), 0, tolerance);
      EXPECT_NEAR(before.gap, after.gap, 0.01 * tolerance + 1e-9);
      EXPECT_NEAR((q * (m.a == 1 ? n : Vec3(-n)) - after.n).norm(), 0, tolerance);
    }
  });
}

// Where two directions are equally good within the tolerance, b's facet is preferred: rare. Of more
// than four points others may be kept that are as deep within the tolerance. Of two cylinders, deep
// in each other, two directions are as good in 8 to 13 % of the samples of thirty seeds.
TEST_P(AnyPair, SwappingTheBodiesMirrorsTheNormal) {
  const Two& two = GetParam();
  int count = 0, same = 0;
  forRandomPoses(two, 300, 0.05, 0.5, [&](const auto& poses, const Manifold& m, const Vec3& n) {
    const auto swapped = meet(two.b.shape, poses[2], two.a.shape, poses[1], 0.05);
    ASSERT_EQ(swapped.size(), 1u);
    const std::vector<Pose> other = {Pose{}, poses[2], poses[1]};
    const Vec3 after = other[swapped[0].b].q * swapped[0].normal;
    const bool mirrored =
        ((swapped[0].a == 1 ? after : Vec3(-after)) + n).norm() < directionTolerance(two);
    ++count;
    if (!mirrored) return;
    ++same;
    const double tolerance = m.count > 2 ? kFlat : 0.1 * directionTolerance(two) + 1e-9;
    EXPECT_NEAR(smallestGap(swapped[0], other), smallestGap(m, poses), tolerance);
  });
  EXPECT_GE(same, count * (searched(two) ? 85 : 97) / 100);
}

TEST_P(AnyPair, CoincidentCentresGiveAFiniteUnitNormal) {
  const Two& two = GetParam();
  for (const Quat& q : {Quat::Identity(), turned(Vec3(1, 2, 3), 40)}) {
    const std::vector<Pose> poses = {Pose{}, {Vec3::Zero(), q}, Pose{}};
    for (const Manifold& m : meet(two.a.shape, poses[1], two.b.shape, poses[2])) {
      EXPECT_NEAR(m.normal.norm(), 1, 1e-12);
      EXPECT_TRUE(std::isfinite(smallestGap(m, poses)));
      const Vec3 n = (m.a == 1 ? 1 : -1) * (poses[m.b].q * m.normal);
      EXPECT_LE(separation(two.a.shape, poses[1], two.b.shape, poses[2], n), 1e-12);
    }
  }
}

}  // namespace
}  // namespace physics
