// Resting poses: how many points, where, and with what gap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "physics/base/rotation.h"
#include "physics/collision/contacts.h"
#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

struct Resting {
  std::string name;
  Shape a;
  Pose poseA;
  Shape b;
  Pose poseB;
  int points = 0;
  Vec3 normal = Vec3::UnitY();  // from b to a, world
};

const Plane kFloor{Vec3(0, 1, 0), 0};
const Quat kLying = turned(Vec3::UnitZ(), 90);  // y axis along -x
const Quat kUpright = Quat::Identity();

std::vector<Resting> restings() {
  const Box slab{Vec3(2, 1, 2)};
  const Pose below{Vec3(0, -.5, 0), kUpright};
  const Cylinder can{.25, .5};
  const Capsule pill{.15, .5};
  const double depth = .5;  // of the cubes below
  return {
      {"PointOnPlane", PointShape{}, {Vec3(1, 0, 2), kUpright}, kFloor, {}, 1},
      {"SphereOnPlane", Sphere{.3}, {Vec3(1, .3, 2), kUpright}, kFloor, {}, 1},
      {"BoxOnPlane", Box{Vec3(1, 1, 1)}, {Vec3(0, .5, 0), kUpright}, kFloor, {}, 4},
      {"BoxOnItsEdgeOnPlane",
       Box{Vec3(1, 1, 1)},
       {Vec3(0, std::sqrt(.5), 0), turned(Vec3::UnitX(), 45)},
       kFloor,
       {},
       2},
      {"SmallBoxOnPlane", Box{Vec3(.01, .01, .01)}, {Vec3(0, .005, 0), kUpright}, kFloor, {}, 4},
      {"LyingCapsuleOnPlane", pill, {Vec3(0, .15, 0), kLying}, kFloor, {}, 2},
      {"UprightCapsuleOnPlane", pill, {Vec3(0, .4, 0), kUpright}, kFloor, {}, 1},
      {"LyingCylinderOnPlane", can, {Vec3(0, .25, 0), kLying}, kFloor, {}, 2},
      {"StandingCylinderOnPlane", can, {Vec3(0, .25, 0), kUpright}, kFloor, {}, 4},
      {"HullOnPlane",
       hullOf(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}),
       {},
       kFloor,
       {},
       3},
      {"BoxOnBox",
       Box{Vec3(1, 1, 1)},
       {Vec3(.2, depth, -.1), turned(Vec3::UnitY(), 10)},
       slab,
       below,
       4},
      {"EqualBoxesAligned",
       Box{Vec3(1, 1, 1)},
       {Vec3(0, depth, 0), kUpright},
       Box{Vec3(1, 1, 1)},
       below,
       4},
      {"BoxTurnedByAnEighth",
       Box{Vec3(1, 1, 1)},
       {Vec3(0, depth, 0), turned(Vec3::UnitY(), 45)},
       Box{Vec3(1, 1, 1)},
       below,
       4},
      {"HalfOffBox",
       Box{Vec3(1, 1, 1)},
       {Vec3(.9, depth, 0), kUpright},
       Box{Vec3(1, 1, 1)},
       below,
       4},
      {"CrossedEdges",
       Box{Vec3(1, 1, 1)},
       {Vec3(0, std::sqrt(2), 0), turned(Vec3::UnitX(), 45)},
       Box{Vec3(1, 1, 1)},
       {Vec3::Zero(), turned(Vec3::UnitZ(), 45)},
       1},
      {"SphereOnSphere", Sphere{.3}, {Vec3(0, .5, 0), kUpright}, Sphere{.2}, {}, 1},
      {"SphereOnBox", Sphere{.3}, {Vec3(.5, .3, 0), kUpright}, slab, below, 1},
      {"SphereOnCylinder", Sphere{.3}, {Vec3(.1, .55, 0), kUpright}, can, {}, 1},
      {"SphereOnCapsule",
       Sphere{.3},
       {Vec3(.1, .45, 0), kUpright},
       pill,
       {Vec3::Zero(), kLying},
       1},
      {"ParallelCapsules", pill, {Vec3(.1, .3, 0), kLying}, pill, {Vec3::Zero(), kLying}, 2},
      {"CrossedCapsules",
       pill,
       {Vec3(0, .3, 0), kLying},
       pill,
       {Vec3::Zero(), turned(Vec3::UnitX(), 90)},
       1},
      {"CapsuleLyingOnBox", pill, {Vec3(0, .15, 0), kLying}, slab, below, 2},
      {"CapsuleAcrossEdge",
       pill,
       {Vec3(0, std::sqrt(.5) + .15, 0), turned(Vec3::UnitX(), 90)},
       Box{Vec3(1, 1, 1)},
       {Vec3::Zero(), turned(Vec3::UnitZ(), 45)},
       1},
      {"CylinderLyingOnBox", can, {Vec3(0, .25, 0), kLying}, slab, below, 2},
      {"CylinderStandingOnBox", can, {Vec3(0, .25, 0), kUpright}, slab, below, 4},
      {"CylinderStandingOnCylinder", can, {Vec3(.1, .5, 0), kUpright}, can, {}, 4},
      {"ParallelCylinders", can, {Vec3(.1, .5, 0), kLying}, can, {Vec3::Zero(), kLying}, 2},
      {"CapsuleAlongCylinder", pill, {Vec3(.1, .4, 0), kLying}, can, {Vec3::Zero(), kLying}, 2},
      {"CapsuleLyingOnCap", pill, {Vec3(0, .4, 0), kLying}, can, {}, 2},
      {"CylinderAcrossCylinder",
       can,
       {Vec3(0, .5, 0), kLying},
       can,
       {Vec3::Zero(), turned(Vec3::UnitX(), 90)},
       1},
  };
}

class Rest : public ::testing::TestWithParam<Resting> {};
INSTANTIATE_TEST_SUITE_P(Pairs, Rest, ::testing::ValuesIn(restings()),
                         [](const auto& info) { return info.param.name; });

Pose restingPose(const Resting& r) {  // the hull of the list lies with one face on the floor
  if (r.name != "HullOnPlane") return r.poseA;
  const auto& hull = *std::get<Convex>(r.a).hull;
  Pose pose;
  pose.q = turnBetween(hull.faces[0].normal, -Vec3::UnitY());
  pose.x.y() = hull.faces[0].offset;
  return pose;
}

TEST_P(Rest, HasTheExpectedPointsWithGapZero) {
  const Resting& r = GetParam();
  const std::vector<Pose> poses = {Pose{}, restingPose(r), r.poseB};
  const auto found = meet(r.a, poses[1], r.b, poses[2]);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].count, r.points);
  std::set<std::uint32_t> features;
  for (int i = 0; i < found[0].count; ++i) {
    const Point point = place(found[0], i, poses);
    EXPECT_NEAR(point.gap, 0, 1e-12);
    EXPECT_NEAR((point.onA - point.onB).norm(), 0, 1e-12);
    const Vec3 up = found[0].a == 1 ? r.normal : Vec3(-r.normal);
    EXPECT_NEAR((point.n - up).norm(), 0, 1e-12);
    features.insert(found[0].points[i].feature);
  }
  EXPECT_EQ(static_cast<int>(features.size()), r.points);
}

TEST_P(Rest, KeepsItsFeaturesUnderAJiggle) {
  const Resting& r = GetParam();
  Random random(3);
  const Pose rest = restingPose(r);
  const auto before = meet(r.a, rest, r.b, r.poseB);
  for (int trial = 0; trial < 100; ++trial) {
    Pose moved = rest;
    moved.x += 1e-6 * random.direction();
    moved.q = turned(random.direction(), 1e-6) * moved.q;
    const auto after = meet(r.a, moved, r.b, r.poseB);
    ASSERT_EQ(after.size(), 1u);
    ASSERT_EQ(after[0].count, before[0].count);
    for (int i = 0; i < after[0].count; ++i) {
      EXPECT_EQ(after[0].points[i].feature, before[0].points[i].feature);
    }
  }
}

// A square that is turned by 45 degrees has two corners furthest along each diagonal.
TEST(ColliderRest, ABoxStandsOnFourCornersHoweverItIsTurned) {
  for (const double width : {1.0, 0.5, 2.0}) {
    for (int degrees = 0; degrees <= 180; degrees += 5) {
      const Box box{Vec3(1, 1, width)};
      const Pose above{Vec3(0, 0.5, 0), turned(Vec3::UnitY(), degrees)};
      const auto onPlane = meet(box, above, Plane{Vec3::UnitY(), 0}, Pose{});
      const auto onBox = meet(box, above, Box{Vec3(4, 1, 4)}, {Vec3(0, -0.5, 0), Quat::Identity()});
      ASSERT_EQ(onPlane.size(), 1u);
      ASSERT_EQ(onBox.size(), 1u);
      EXPECT_EQ(onPlane[0].count, 4) << width << " at " << degrees;
      EXPECT_EQ(onBox[0].count, 4) << width << " at " << degrees;
    }
  }
}

// Corners in order; four of a circle's span 2/pi of it.
TEST(ColliderRest, FourPointsSpanAtLeastHalfOfWhatTouches) {
  const auto areaOf = [](std::span<const collision::Spot> corners) {
    double twice = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const collision::Spot &a = corners[i], &b = corners[(i + 1) % corners.size()];
      twice += a.u * b.v - a.v * b.u;
    }
    return 0.5 * twice;
  };
  Random random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    const int count = 3 + trial % 14;
    const double flat = random.number(0.02, 1), turn = random.number(0, 6.28);
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) angles.push_back(random.number(0, 6.28));
    std::sort(angles.begin(), angles.end());
    std::vector<collision::Spot> spots;
    for (const double angle : angles) {
      const double x = std::cos(angle), y = flat * std::sin(angle);
      spots.push_back({x * std::cos(turn) - y * std::sin(turn),
                       x * std::sin(turn) + y * std::cos(turn), 0, 0, 0});
    }
    collision::Choice chosen = collision::choose(spots, {.keep = 1, .tie = 1e-6, .clearly = 1});
    chosen.sort([](int i) { return i; });
    std::vector<collision::Spot> kept;
    for (int k = 0; k < chosen.count; ++k) kept.push_back(spots[chosen.index[k]]);
    EXPECT_GT(areaOf(kept), 0.5 * areaOf(spots)) << trial;
    EXPECT_LE(chosen.count, 4);
  }
}

// An octagon, four corners of which span the most. Those change with what the body leans on, not
// back when it leans no more: else it would lean again.
TEST(ColliderRest, ACornerThatWasLeantOnStays) {
  std::vector<collision::Spot> spots;
  for (std::uint32_t k = 0; k < 8; ++k) {
    const double angle = 0.1 + k * std::numbers::pi / 4;
    spots.push_back({std::cos(angle), std::sin(angle), 0, 0, 100 + k});
  }
  std::vector<std::uint32_t> before;
  const auto chosen = [&] {
    const collision::Limits limits{.keep = 1, .tie = 1e-6, .clearly = 1e-3, .before = before};
    const collision::Choice choice = collision::choose(spots, limits);
    std::vector<std::uint32_t> features;
    for (int k = 0; k < choice.count; ++k) features.push_back(spots[choice.index[k]].feature);
    std::sort(features.begin(), features.end());
    return features;
  };
  const std::vector<std::uint32_t> level = chosen();
  ASSERT_EQ(level.size(), 4u);
  const auto other = [&](const collision::Spot& s) {
    return std::find(level.begin(), level.end(), s.feature) == level.end();
  };
  const auto corner = std::find_if(spots.begin(), spots.end(), other);
  before = level;
  EXPECT_EQ(chosen(), level);
  corner->gap = -0.01;
  const std::vector<std::uint32_t> leaning = chosen();
  EXPECT_EQ(std::count(leaning.begin(), leaning.end(), corner->feature), 1);
  corner->gap = 0;
  before = leaning;
  EXPECT_EQ(chosen(), leaning);
  before = {100, 101, 102, 103};  // on one side: they span less than half
  EXPECT_EQ(chosen(), level);
}

// Cubes over each other at 45 degrees: eight corners, four of which span the most. The one that the
// step turns in the furthest is one of those that are kept, whichever it is: else what falls on it
// would go in as far before it is seen.
TEST(ColliderRest, TheCornerThatTurnsInIsKept) {
  const double half = 0.5, cut = half * (std::sqrt(2.0) - 1);
  for (int direction = 0; direction < 32; ++direction) {
    const double angle = 0.05 + direction * std::numbers::pi / 16;
    const Vec3 axis(std::cos(angle), 0, std::sin(angle));
    for (const bool upperTurns : {true, false}) {
      Collider collider;
      collider.add(0, Box{Vec3(1, 1, 1)}, true);
      collider.add(1, Box{Vec3(1, 1, 1)}, true);
      const std::vector<Pose> start = {{Vec3::Zero(), kUpright},
                                       {Vec3(0, 1.02, 0), turned(Vec3::UnitY(), 45)}};
      std::vector<Pose> end = start;
      Quat& turns = end[upperTurns].q;
      turns = exponential(0.06 * axis) * turns;
      const auto manifolds = collider.find(start, end, 0.04);
      ASSERT_EQ(manifolds.size(), 1u);
      const double kept = smallestGap(manifolds[0], end);
      double lowest = 1;  // of all eight, at first order of the turn
      for (const double x : {-half, -cut, cut, half}) {
        for (const double z : {-half, -cut, cut, half}) {
          if (std::abs(x) == std::abs(z)) continue;
          lowest = std::min(lowest, 0.02 - std::abs(0.06 * axis.cross(Vec3(x, 0, z)).y()));
        }
      }
      EXPECT_NEAR(kept, lowest, 3e-3) << direction << ' ' << upperTurns;
    }
  }
}

// Its bounds were taken with all others at first; they are not of those that move now.
TEST(ColliderRest, OneThatComesToAnotherThatRestsIsFoundWhicheverWasAddedFirst) {
  for (const BodyId still : {1, 2}) {
    const BodyId comes = 3 - still;
    Collider collider;
    for (const BodyId body : {1, 2}) collider.add(body, Box{Vec3(1, 1, 1)}, body == comes);
    std::vector<Pose> pose(3);
    collider.rest(std::array{still}, pose);
    bool found = false;
    for (int k = 0; k < 100; ++k) {
      pose[comes].x = Vec3(0, 10 - 0.0909 * k, 0);
      found = !collider.find(pose, pose, 0.02).empty();
    }
    EXPECT_TRUE(found) << "still " << still;
  }
}

}  // namespace
}  // namespace physics
