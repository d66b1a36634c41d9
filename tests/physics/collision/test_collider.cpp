// The collider as a whole: what it keeps, its order, who is left out.
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>
#include <numeric>

#include "physics/base/workers.h"
#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

struct Pile {
  Collider collider;
  std::vector<Pose> poses = {Pose{}};

  void add(const Shape& shape, const Vec3& x, bool movable = true) {
    collider.add(static_cast<BodyId>(poses.size()), shape, movable);
    poses.push_back({x, Quat::Identity()});
  }
  std::vector<BodyId> bodies() const {
    std::vector<BodyId> all(poses.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  std::vector<Manifold> find(double margin = 0.02) {
    const auto found = collider.find(poses, poses, margin);
    return {found.begin(), found.end()};
  }
};

Pile pyramid(int base) {
  Pile pile;
  pile.add(Plane{}, Vec3::Zero(), false);
  for (int row = 0; row < base; ++row) {
    for (int i = 0; i < base - row; ++i) pile.add(Box{}, Vec3(1.1 * (i + .5 * row), row + .5, 0));
  }
  return pile;
}

bool equal(const Manifold& p, const Manifold& q) {
  bool same = p.a == q.a && p.b == q.b && p.count == q.count && p.normal == q.normal;
  for (int i = 0; same && i < p.count; ++i) {
    same = p.points[i].coreA == q.points[i].coreA && p.points[i].coreB == q.points[i].coreB &&
           p.points[i].feature == q.points[i].feature;
  }
  return same;
}

TEST(Collider, FindsEveryContactOfAPyramidInOrder) {
  Pile pile = pyramid(6);
  const auto found = pile.find();
  EXPECT_EQ(found.size(), 6u + 2 * 15u);
  for (const Manifold& m : found) EXPECT_EQ(m.count, m.b == 1 ? 4 : 4);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_LT(std::pair(found[i - 1].a, found[i - 1].b), std::pair(found[i].a, found[i].b));
  }
}

TEST(Collider, KeepsTheManifoldsOfBodiesAtRestWithoutLookingAgain) {
  Pile pile = pyramid(6);
  const auto before = pile.find();
  const auto calls = pile.collider.counts();
  for (Pose& pose : pile.poses) pose.x += Vec3::Constant(1e-6);
  pile.poses[0].x = pile.poses[1].x = Vec3::Zero();
  const auto after = pile.find();
  EXPECT_EQ(pile.collider.counts().narrowPhaseCalls, calls.narrowPhaseCalls);
  EXPECT_EQ(pile.collider.counts().broadPhaseCalls, calls.broadPhaseCalls);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_TRUE(equal(after[i], before[i]));
}

TEST(Collider, LooksAgainAtABodyThatMoved) {
  Pile pile = pyramid(6);
  pile.find();
  const auto calls = pile.collider.counts().narrowPhaseCalls;
  pile.poses.back().x.x() += .01;
  const auto after = pile.find();
  EXPECT_GT(pile.collider.counts().narrowPhaseCalls, calls);
  EXPECT_LE(pile.collider.counts().narrowPhaseCalls, calls + 4);
  Pile fresh = pyramid(6);
  fresh.poses = pile.poses;
  const auto expected = fresh.find();
  ASSERT_EQ(after.size(), expected.size());
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_TRUE(equal(after[i], expected[i]));
}

TEST(Collider, FollowsBodiesThatMeetAndPart) {
  Pile pile;
  pile.add(Sphere{.5}, Vec3::Zero(), false);
  pile.add(Sphere{.5}, Vec3(3, 0, 0));
  for (const auto& [x, expected] :
       {std::pair(3.0, 0u), {1.0, 1u}, {2.0, 0u}, {-1.0, 1u}, {-5.0, 0u}, {.5, 1u}}) {
    pile.poses[2].x.x() = x;
    EXPECT_EQ(pile.find().size(), expected) << x;
  }
}

TEST(Collider, IsNotChangedByBodiesElsewhere) {
  Pile alone = pyramid(5), crowded = pyramid(5);
  Random random(4);
  for (int i = 0; i < 50; ++i) crowded.add(Sphere{.2}, Vec3(0, 5, 50) + 5 * random.direction());
  for (int step = 0; step < 5; ++step) {
    for (std::size_t i = 2; i < alone.poses.size(); ++i) {
      alone.poses[i].x += 1e-3 * random.direction();
      crowded.poses[i] = alone.poses[i];
    }
    const auto expected = alone.find(), all = crowded.find();
    std::vector<Manifold> ours;
    for (const Manifold& m : all) {
      if (m.a < static_cast<BodyId>(alone.poses.size())) ours.push_back(m);
    }
    ASSERT_EQ(ours.size(), expected.size());
    for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_TRUE(equal(ours[i], expected[i]));
  }
}

TEST(Collider, FindsTheSameOnThreeThreads) {
  Pile whole = pyramid(20), parts = pyramid(20);
  Workers workers;
  workers.setCount(3);
  Random random(5);
  for (int step = 0; step < 4; ++step) {
    for (std::size_t i = 2; i < whole.poses.size(); ++i) {
      whole.poses[i].x += 2e-3 * random.direction();
      parts.poses[i] = whole.poses[i];
    }
    const auto expected = whole.find();
    const auto found = parts.collider.look(parts.poses, parts.poses, .02, {}, workers);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_TRUE(equal(*found[i].manifold, expected[i]));
    EXPECT_EQ(parts.collider.counts().narrowPhaseCalls, whole.collider.counts().narrowPhaseCalls);
  }
}

TEST(Collider, LeavesIgnoredPairsOutAlsoLater) {
  Pile pile;
  for (int i = 0; i < 3; ++i) pile.add(Box{}, Vec3(0, i, 0));
  pile.collider.ignore(2, 1);
  EXPECT_EQ(pile.find().size(), 1u);
  pile.collider.ignore(2, 3);
  EXPECT_EQ(pile.find().size(), 0u);
}

TEST(Collider, LeavesOutPairsThatCanNotMoveAndPairsOfPoints) {
  Pile pile;
  pile.add(Box{}, Vec3::Zero(), false);
  pile.add(Box{}, Vec3(0, .5, 0), false);
  pile.add(PointShape{}, Vec3(5, 0, 0));
  pile.add(PointShape{}, Vec3(5, 0, 0));
  EXPECT_TRUE(pile.find().empty());
  EXPECT_EQ(pile.collider.counts().pairs, 0);
}

TEST(Collider, MovingAPlaneIsSeen) {
  Pile pile;
  pile.add(Plane{}, Vec3(0, -5, 0), false);
  pile.add(Sphere{.5}, Vec3::Zero());
  EXPECT_TRUE(pile.find().empty());
  pile.poses[1].x.y() = -.5;
  EXPECT_EQ(pile.find().size(), 1u);
}

TEST(Collider, TellsWhenBodiesLeaveTheBoundsItLookedIn) {
  Pile pile = pyramid(3);
  pile.find();
  EXPECT_FALSE(pile.collider.outdated(pile.poses, pile.poses, pile.bodies()));
  std::vector<Pose> end = pile.poses;
  end[4].x.x() += 1;
  EXPECT_TRUE(pile.collider.outdated(pile.poses, end, pile.bodies()));
}

// A box that lay on another is beside it now.
TEST(Collider, LooksAtAPairThatItFoundWhereItsBodiesAreNow) {
  Pile pile;
  pile.add(Box{}, Vec3::Zero(), false);
  pile.add(Box{}, Vec3(0, 1.001, 0));
  const std::vector<Manifold> found = pile.find();
  ASSERT_EQ(found.size(), 1u);
  const Manifold& on = found[0];
  const auto at = [&](const Vec3& x, double near) {
    std::array<Pose, 3> poses = {Pose{}, pile.poses[1], pile.poses[2]};
    poses[2].x = x;
    Manifold manifold;
    EXPECT_TRUE(pile.collider.lookAt(on.pair, poses[on.a], poses[on.b], near, 0, manifold));
    return manifold;
  };
  EXPECT_TRUE(equal(at(Vec3(0, 1.001, 0), 0.02), on));
  const Manifold beside = at(Vec3(1.01, 0, 0), 0.02);
  EXPECT_EQ(beside.count, 4);
  EXPECT_NEAR(std::abs(beside.normal.x()), 1, 1e-12);
  EXPECT_EQ(at(Vec3(1.01, 0, 0), 0.005).count, 0);
  EXPECT_EQ(beside.pair, on.pair);
}

TEST(Collider, DistanceOfABodyWithoutShapeIsInfinite) {
  Pile pile;
  pile.add(Sphere{.5}, Vec3::Zero());
  EXPECT_EQ(pile.collider.distance(0, Pose{}, 1, Pose{}), std::numeric_limits<double>::infinity());
}

TEST(Collider, RefusesWhatItCanNotTake) {
  Pile pile;
  pile.add(Sphere{.5}, Vec3::Zero());
  EXPECT_THROW(pile.collider.add(1, Sphere{.5}, true), std::invalid_argument);
  EXPECT_THROW(pile.collider.add(2, Sphere{0}, true), std::invalid_argument);
  EXPECT_THROW(pile.collider.add(2, Plane{}, true), std::invalid_argument);
  EXPECT_THROW(pile.find(-1), std::invalid_argument);
  EXPECT_THROW(pile.collider.find({}, {}, 0), std::invalid_argument);
}

// Nearly parallel faces that overlap: two edges are often the nearest features, but of boxes that
// turn by more than the faces are apart any corner may touch before the next look.
TEST(Collider, FacesOfBoxesThatTurnMeetWithAllOfTheirCorners) {
  Random random(3);
  int edgesWhenStill = 0;
  for (int i = 0; i < 300; ++i) {
    Pose upper{Vec3{random.number(-0.3, 0.3), 0.97, random.number(-0.3, 0.3)}, Quat::Identity()};
    const Quat twist = turned(Vec3::UnitY(), random.number(20, 70));
    upper.q = random.lean(1, 4) * twist;
    Collider collider;
    collider.add(1, Box{Vec3(1, 1, 1)}, true);
    collider.add(2, Box{Vec3(1, 1, 1)}, false);
    const std::vector<Pose> start = {{}, upper, {}};
    const std::span<const Manifold> still = collider.find(start, start, 0.02);
    ASSERT_EQ(still.size(), 1u);
    EXPECT_GT(still[0].count, 2) << i;
    const Vec3 n = start[still[0].b].q * still[0].normal, seen = upper.q.conjugate() * n;
    edgesWhenStill += std::abs(n.y()) < 1 - 1e-9 && std::abs(seen.y()) < 1 - 1e-9;
    std::vector<Pose> end = start;
    end[1].q = turned(Vec3::UnitX(), 20) * upper.q;
    const std::span<const Manifold> turning = collider.find(start, end, 0.02);
    ASSERT_EQ(turning.size(), 1u);
    EXPECT_GT(turning[0].count, 2) << i;
    EXPECT_GT(std::abs(turning[0].normal.y()), 0.99) << i;
  }
  EXPECT_GT(edgesWhenStill, 30);
}

// A bar over two edges of a box, lower at one of them: when it turns it meets the other, whose gap
// along the present normal is what the face falls off by.
TEST(Collider, ABarThatLiesOnAnEdgeKnowsTheOneItTurnsTo) {
  const double degrees = 1, tilt = degrees * std::numbers::pi / 180, radius = 0.09, overlap = 1e-3;
  const double height = 0.5 + (radius - overlap) / std::cos(tilt) + 0.4 * std::tan(tilt);
  const std::vector<Pose> poses = {{}, {Vec3(0.1, height, 0), turned(Vec3::UnitZ(), 89)}, {}};
  const std::vector<Manifold> found =
      meet(Capsule{radius, 3}, poses[1], Box{Vec3(1, 1, 1)}, poses[2]);
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].count, 2);
  Point near = place(found[0], 0, poses), far = place(found[0], 1, poses);
  if (near.gap > far.gap) std::swap(near, far);
  EXPECT_NEAR(near.n.y(), std::cos(tilt), 1e-9);  // of the edge, not of the face
  EXPECT_NEAR(near.gap, -overlap, 1e-4);
  EXPECT_NEAR(far.gap - near.gap, std::sin(tilt), 1e-4);
  EXPECT_NEAR(near.onB.x(), 0.5, 1e-3);
  EXPECT_NEAR(far.onB.x(), -0.5, 1e-2);
}

// A face on a ridge, lower at one of its sides: that side and the ridge touch, and when the face
// turns it meets the ridge at the other side, whichever of the two bodies it is of.
TEST(Collider, AFaceOnARidgeIsKnownAtBothOfItsSides) {
  const double degrees = 1, tilt = degrees * std::numbers::pi / 180, overlap = 1e-3;
  const Box block{Vec3(1, 1, 1)}, beam{Vec3(1, 1, 3)};
  const Pose ridge{Vec3(0, -std::sqrt(0.5), 0), turned(Vec3::UnitZ(), 45)};
  const double height = 0.5 * std::cos(tilt) + 0.5 * std::sin(tilt) - overlap;
  const Pose above{Vec3(0, height, 0), turned(Vec3::UnitX(), degrees)};
  for (const bool isFirst : {true, false}) {
    const auto found = isFirst ? meet(block, above, beam, ridge) : meet(beam, ridge, block, above);
    const std::vector<Pose> poses = {{}, isFirst ? above : ridge, isFirst ? ridge : above};
    ASSERT_EQ(found.size(), 1u);
    ASSERT_EQ(found[0].count, 2);
    Point near = place(found[0], 0, poses), far = place(found[0], 1, poses);
    if (near.gap > far.gap) std::swap(near, far);
    EXPECT_NEAR(std::abs(near.n.y()), 1, 1e-9);  // of the ridge and the side, not of the face
    EXPECT_NEAR(near.gap, -overlap, 1e-9);
    EXPECT_NEAR(far.gap - near.gap, std::tan(tilt), 1e-3);
    EXPECT_NEAR(near.onB.z(), 0.5, 1e-2);
    EXPECT_NEAR(far.onB.z(), -0.5, 1e-2);
  }
}

// Two bars that are nearly parallel: where they part, their sides are further from each other than
// in the middle, and points face each other along the normal.
TEST(Collider, BarsThatNearlyLieAlongEachOtherKnowWhereTheyPart) {
  const double radius = 0.1, half = 0.5, degrees = 8;
  const Pose lower{}, upper{Vec3(0, 0, 2 * radius), turned(Vec3::UnitZ(), degrees)};
  const std::vector<Manifold> found =
      meet(Capsule{radius, 2 * half}, upper, Capsule{radius, 2 * half}, lower);
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].count, 3);
  const std::vector<Pose> poses = {{}, upper, lower};
  const double off = half * std::tan(degrees * std::numbers::pi / 180);
  double most = 0, least = 1;
  for (int k = 0; k < 3; ++k) {
    const Point point = place(found[0], k, poses);
    most = std::max(most, point.gap);
    least = std::min(least, point.gap);
    const Vec3 apart = point.onA - point.onB;
    EXPECT_NEAR((apart - point.gap * point.n).norm(), 0, 1e-12);
  }
  EXPECT_NEAR(least, 0, 1e-12);
  EXPECT_NEAR(most, 2 * radius - std::sqrt(4 * radius * radius - off * off), 1e-3);
}

}  // namespace
}  // namespace physics
