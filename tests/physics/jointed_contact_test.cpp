// Jointed bodies in contact, and joints put together wrong.
#include <gtest/gtest.h>

#include "physics/constraints/ball_socket.h"
#include "physics/constraints/cone_limit.h"
#include "physics/constraints/volume.h"
#include "physics/small_steps/island_plan.h"
#include "physics/world.h"
#include "physics/world/measure.h"

namespace physics {
namespace {

Settings touching() {
  Settings settings;
  settings.contact = ContactSettings{};
  return settings;
}

void addFloor(World& world) {
  BodyDef ground;
  ground.shape = Plane{Vec3(0, 1, 0), 0};
  ground.motion = Motion::kStatic;
  world.add(ground);
}

BodyId addBlock(World& world, const Vec3& size, const Vec3& x, double mass) {
  BodyDef box;
  box.shape = Box{size};
  box.pose.x = x;
  box.mass = mass;
  return world.add(box);
}

void join(World& world, BodyId a, BodyId b, const Vec3& at) {
  BallSocketDef joint;
  joint.bodies = {a, b};
  joint.at = at;
  world.add(joint);
}

double fastest(const World& world) {
  double most = 0;
  for (const Velocity& velocity : world.bodies().velocity) most = std::max(most, velocity.v.norm());
  return most;
}

double errorOf(const World& world, const std::string& kind) {
  for (const KindError& error : world.constraintErrors()) {
    if (error.kind == kind) return error.largest;
  }
  return -1;
}

// Two boxes on a ball joint, the first of them 1 cm deep in the ground, without gravity.
struct Sunk {
  World world;
  BodyId a, b;
  explicit Sunk(const Settings& settings) : world(settings) {
    addFloor(world);
    a = addBlock(world, Vec3(0.4, 0.4, 0.4), Vec3(0, 0.19, 0), 1);
    b = addBlock(world, Vec3(0.4, 0.2, 0.2), Vec3(0.45, 0.3, 0), 2);
    join(world, a, b, Vec3(0.22, 0.3, 0));
  }
};

// A bound that is not reached takes no part in it.
TEST(JointedContact, ALimitWithRoomChangesNothing) {
  Sunk free(touching()), limited(touching());
  ConeLimitDef limit;
  limit.bodies = {limited.a, limited.b};
  limit.angle = 0.5;
  limited.world.add(limit);
  for (int k = 0; k < 30; ++k) {
    free.world.step();
    limited.world.step();
    const Pose &p = free.world.bodies().pose[free.b], &q = limited.world.bodies().pose[limited.b];
    ASSERT_LT((p.x - q.x).norm(), 1e-12) << "step " << k;
  }
}

// The feet carry forty times their own weight. The multipliers of their contacts, applied before
// those of the joints, would throw them by metres in a step this long.
TEST(JointedContact, LightFeetUnderAHeavyBodyRestAtTenStepsASecond) {
  Settings s = touching();
  s.dt = 0.1;
  s.substeps = 1;
  s.gravity = Vec3(0, -9.81, 0);
  World world(s);
  addFloor(world);
  const BodyId body = addBlock(world, Vec3(1, 0.3, 0.6), Vec3(0, 0.45, 0), 64);
  for (const double x : {-0.4, 0.4}) {
    for (const double z : {-0.2, 0.2}) {
      const BodyId foot = addBlock(world, Vec3(0.1, 0.2, 0.1), Vec3(x, 0.15, z), 0.4);
      join(world, body, foot, Vec3(x, 0.28, z));
    }
  }
  double most = 0;
  for (int k = 0; k < 100; ++k) {
    ASSERT_FALSE(world.step().notFinite);
    if (k >= 80) most = std::max(most, fastest(world));
  }
  EXPECT_LT(most, 0.05);
}

// An arm over a body, both of which fall alike. Where the body is stopped the arm goes on, about
// its joint, and reaches the body within that step.
TEST(JointedContact, AnArmThatAHitFlingsMeetsItsOwnBody) {
  Settings s = touching();
  s.gravity = Vec3(0, -9.81, 0);
  World world(s);
  addFloor(world);
  const BodyId body = addBlock(world, Vec3(1, 0.1, 0.5), Vec3(0, 0.07, 0), 20);
  const BodyId post = addBlock(world, Vec3(0.1, 0.4, 0.1), Vec3(-0.45, 0.32, 0), 1);
  const BodyId arm = addBlock(world, Vec3(0.8, 0.06, 0.06), Vec3(0, 0.25, 0), 1);
  for (const double x : {-0.5, -0.4}) {
    for (const double z : {-0.05, 0.05}) join(world, body, post, Vec3(x, 0.12, z));
  }
  join(world, post, arm, Vec3(-0.4, 0.25, 0));
  for (const BodyId i : {body, post, arm}) world.setVelocity(i, {Vec3(0, -20, 0), Vec3::Zero()});
  double most = 0;
  for (int k = 0; k < 30; ++k) {
    ASSERT_FALSE(world.step().notFinite);
    most = std::max(most, world.largestOverlap());
  }
  EXPECT_LT(most, 1e-3);
}

// A hand of 0.45 kg at an arm, and 100 kg on it: by its own mass it would give way by 7 mm or more.
struct LoadedHand {
  World world;
  BodyId hand, load;
  LoadedHand() : world(heavy()) {
    addFloor(world);
    const BodyId arm = addBlock(world, Vec3(0.3, 0.06, 0.06), Vec3(-0.2, 0.04, 0), 2);
    hand = addBlock(world, Vec3(0.1, 0.08, 0.08), Vec3(0, 0.04, 0), 0.45);
    load = addBlock(world, Vec3(0.3, 0.3, 0.3), Vec3(0, 0.231, 0), 100);
    join(world, arm, hand, Vec3(-0.05, 0.04, 0));
  }
  static Settings heavy() {
    Settings settings = touching();
    settings.gravity = Vec3(0, -9.81, 0);
    return settings;
  }
  double height() const { return world.bodies().pose[hand].x.y(); }
};

TEST(JointedContact, AHandUnderAHeavyBlockComesToRestOnTheFloor) {
  LoadedHand held;
  for (int k = 0; k < 240; ++k) ASSERT_FALSE(held.world.step().notFinite);
  EXPECT_LT(fastest(held.world), 1e-3);
  EXPECT_LT(held.world.largestOverlap(), 2e-4);
}

TEST(JointedContact, AHandThatAHeavyBlockLeavesDoesNotHover) {
  LoadedHand held;
  for (int k = 0; k < 240; ++k) held.world.step();
  const double loaded = held.height();
  held.world.setVelocity(held.load, {Vec3(3, 3, 0), Vec3::Zero()});
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    held.world.step();
    most = std::max(most, held.height() - loaded);
  }
  EXPECT_LT(most, 5e-3);
  EXPECT_NEAR(held.height(), loaded, 5e-4);
}

// Twenty planks end to end between two posts, without slack: to hold anything at all they would
// have to be longer, and what they are off by is a sag of its root. A tenth of a millimetre that a
// step left open threw the block off with ten times the energy that it fell with.
struct Falls {
  double mass, rise;  // kg; of the energy, as a share of what the block falls with
};
class TautBridge : public ::testing::TestWithParam<Falls> {};

TEST_P(TautBridge, HoldsWhatFallsOnItAndGivesItNoEnergy) {
  Settings settings = touching();
  settings.gravity = Vec3(0, -9.81, 0);
  World world(settings);
  constexpr int kPlanks = 20;
  constexpr double kLength = 0.5, kDrop = 0.2;
  std::vector<BodyId> planks = {kWorldBody};
  for (int k = 0; k < kPlanks; ++k) {
    const double x = (k - 0.5 * (kPlanks - 1)) * kLength;
    planks.push_back(addBlock(world, Vec3(0.48, 0.1, 1.6), Vec3(x, 0, 0), 20));
  }
  planks.push_back(kWorldBody);
  for (int k = 0; k <= kPlanks; ++k) {
    for (const double side : {-0.7, 0.7}) {
      join(world, planks[k], planks[k + 1], Vec3((k - 0.5 * kPlanks) * kLength, 0, side));
    }
  }
  const BodyId block = addBlock(world, Vec3(1, 1, 1), Vec3(0, 0.55 + kDrop, 0), GetParam().mass);
  const double start = measure(world).total(), fall = GetParam().mass * 9.81 * kDrop;
  double most = start;
  for (int k = 0; k < 120; ++k) {
    world.step();
    most = std::max(most, measure(world).total());
  }
  EXPECT_LT(most - start, GetParam().rise * fall);
  EXPECT_LT(errorOf(world, BallSocketDef::kWord), 1e-5);
  EXPECT_NEAR(world.bodies().pose[block].x.y(), 0.55, 0.1);
}

// Of 10 t the hit is not resolved by the most substeps that there are.
INSTANTIATE_TEST_SUITE_P(JointedContact, TautBridge,
                         ::testing::Values(Falls{100, 0.03}, Falls{1000, 0.003}, Falls{3000, 0.001},
                                           Falls{10000, 0.25}));

// Sixteen planks in an arc, and three crates on them that swing with it. What the crates rest with
// parts them from the planks by next to nothing and lifts them by as much: no reason to leave it
// out for a substep, in which they would fall by 80 mm/s.
TEST(JointedContact, CratesOnABridgeThatSwingsGoWithItsPlanks) {
  Settings settings = touching();
  settings.gravity = Vec3(0, -9.81, 0);
  World world(settings);
  constexpr int kPlanks = 16;
  constexpr double kRadius = 9, kTurn = 0.04;  // m, rad from plank to plank
  const auto cornerOf = [](double k) {
    const double angle = (k - 0.5 * kPlanks) * kTurn;
    return Vec3(kRadius * std::sin(angle), kRadius * (1 - std::cos(angle)), 0);
  };
  std::vector<BodyId> planks = {kWorldBody};
  for (int k = 0; k < kPlanks; ++k) {
    const Vec3 along = cornerOf(k + 1) - cornerOf(k);
    BodyDef plank;
    plank.shape = Box{Vec3(0.95 * along.norm(), 0.06, 1.4)};
    plank.pose = {0.5 * (cornerOf(k) + cornerOf(k + 1)), turnBetween(Vec3::UnitX(), along)};
    plank.mass = 19;
    planks.push_back(world.add(plank));
  }
  planks.push_back(kWorldBody);
  for (int k = 0; k <= kPlanks; ++k) {
    if (planks[k] != kWorldBody && planks[k + 1] != kWorldBody) {
      world.ignoreCollision(planks[k], planks[k + 1]);
    }
    for (const double side : {-0.6, 0.6}) {
      join(world, planks[k], planks[k + 1], cornerOf(k) + side * Vec3::UnitZ());
    }
  }
  std::vector<BodyId> crates;
  for (const double x : {-1.0, 0.0, 1.0}) {
    crates.push_back(addBlock(world, Vec3(0.4, 0.4, 0.4), Vec3(x, 0.5, 0), 26));
  }
  std::vector<double> before(crates.size());
  double most = 0;
  for (int k = 0; k < 480; ++k) {
    world.step();
    for (std::size_t i = 0; i < crates.size(); ++i) {
      const double now = world.bodies().velocity[crates[i]].v.y();
      if (k > 240) most = std::max(most, std::abs(now - before[i]));
      before[i] = now;
    }
  }
  EXPECT_LT(most, 0.04);
}

// A belt of 40 slats over two drums, and ten boxes that fall on it: its slats pull each other with
// some hundred times their weight. By one socket between two slats, or by two beside each other,
// whose pulls go past the arms that they have from the slats' centres.
class Belt : public ::testing::TestWithParam<int> {
 public:
  Belt() : world(settingsOf()) {
    for (const double side : {-0.5, 0.5}) addDrum(side * kApart);
    for (int k = 0; k < kSlats; ++k) addSlat(cornerOf(k), cornerOf(k + 1));
    for (int k = 0; k < kSlats; ++k) joinSlats(k);
    for (int k = 0; k < kBoxes; ++k) {
      const double x = kApart * ((k + 0.5) / kBoxes - 0.5);
      addBlock(world, Vec3(0.24, 0.24, 0.24), Vec3(x, kRadius + 0.3, 0), 2);
    }
  }

 protected:
  static constexpr int kSlats = 40, kBoxes = 10;
  static constexpr double kRadius = 0.53, kLength = 0.2;  // m, of the slats' centres
  static constexpr double kApart = 0.5 * (0.995 * kSlats * kLength - 2 * kPi * kRadius);
  World world;
  std::vector<BodyId> slats;

  static Settings settingsOf() {
    Settings settings = touching();
    settings.gravity = Vec3(0, -9.81, 0);
    return settings;
  }
  void addDrum(double x) {
    BodyDef drum;
    drum.shape = Capsule{0.5, 2};
    drum.pose = {Vec3(x, 0, 0), Quat(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()))};
    drum.motion = Motion::kStatic;
    world.add(drum);
  }
  // Clockwise, from above the left drum.
  static Vec3 cornerOf(int k) {
    const double around = kPi * kRadius, half = kApart + around;
    const double s = 2 * half * (k % kSlats) / kSlats, t = std::fmod(s, half);
    const double side = s < half ? 1 : -1;
    if (t < kApart) return side * Vec3(t - 0.5 * kApart, kRadius, 0);
    const double angle = (t - kApart) / kRadius;
    return side * Vec3(0.5 * kApart + kRadius * std::sin(angle), kRadius * std::cos(angle), 0);
  }
  void addSlat(const Vec3& from, const Vec3& to) {
    const Vec3 along = to - from;
    BodyDef slat;
    slat.shape = Box{Vec3(0.9 * along.norm(), 0.04, 0.8)};
    slat.pose = {0.5 * (from + to), turnBetween(Vec3::UnitX(), along)};
    slat.mass = 0.5;
    slats.push_back(world.add(slat));
  }
  void joinSlats(int k) {
    const BodyId a = slats[(k + kSlats - 1) % kSlats], b = slats[k];
    world.ignoreCollision(a, b);
    const Vec3 at = cornerOf(k);
    if (GetParam() == 1) return join(world, a, b, at);
    for (const double side : {-0.3, 0.3}) join(world, a, b, at + side * Vec3::UnitZ());
  }
};

TEST_P(Belt, ComesToRestInFewSubsteps) {
  for (int k = 0; k < 240; ++k) world.step();
  int most = 0;
  const IslandListening listening(
      [&](const IslandPlan& plan) { most = std::max(most, plan.substeps); });
  for (int k = 0; k < 60; ++k) {
    world.step();
    EXPECT_LT(fastest(world), 5e-3);
  }
  EXPECT_LE(most, 8);
  EXPECT_LT(errorOf(world, BallSocketDef::kWord), 1e-5);
  EXPECT_LT(world.largestOverlap(), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(JointedContact, Belt, ::testing::Values(1, 2));

Settings slow() {
  Settings settings;
  settings.maxCorrectionSpeed = 2;
  return settings;
}

// 0.5 m at 2 m/s, and by the motion that the last substep leaves a little faster.
TEST(MaxCorrectionSpeed, AnOpenJointClosesNoFaster) {
  World world(slow());
  const BodyId a = addBlock(world, Vec3(0.2, 0.2, 0.2), Vec3(0, 0, 0), 1);
  const BodyId b = addBlock(world, Vec3(0.2, 0.2, 0.2), Vec3(0.5, 0, 0), 3);
  BallSocketDef joint;
  joint.bodies = {a, b};
  joint.anchors = {{Vec3::Zero(), Vec3::Zero()}};
  world.add(joint);
  double gap = 0.5;
  for (int k = 0; k < 30; ++k) {
    world.step();
    const auto& pose = world.bodies().pose;
    const double now = (pose[a].x - pose[b].x).norm();
    ASSERT_GT(now, gap - 2.0 / 60 * 1.51) << "step " << k;
    gap = now;
  }
  EXPECT_LT(gap, 1e-6);
}

// A flat tetrahedron gets its volume back, and no corner is faster than the bound allows a length
// of its size.
TEST(MaxCorrectionSpeed, AFlatTetrahedronSwellsNoFaster) {
  World world(slow());
  std::vector<BodyId> corners;
  for (const Vec3& x : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.3, 0.3, 0)}) {
    BodyDef point;
    point.shape = PointShape{};
    point.pose.x = x;
    corners.push_back(world.add(point));
  }
  VolumeDef volume;
  volume.bodies = {corners[0], corners[1], corners[2], corners[3]};
  volume.volume = 0.1;
  world.add(volume);
  for (int k = 0; k < 60; ++k) {
    world.step();
    ASSERT_LT(fastest(world), 4) << "step " << k;
  }
  EXPECT_LT(errorOf(world, "volume"), 1e-3);
}

}  // namespace
}  // namespace physics
