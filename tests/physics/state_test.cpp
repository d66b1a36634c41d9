// A World that takes a state from outside, and tells its constraints as values.
#include <gtest/gtest.h>

#include <limits>

#include "physics/constraints/constraint_item.h"
#include "physics/world.h"
#include "physics/world/measure.h"
#include "tests/physics/stage.h"

namespace physics {
namespace {

World makeBalls(Settings settings = {}) {  // two that overlap by 0.1 m, one of them on a spring
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  World world(settings);
  for (const double x : {0.0, 0.9}) {
    BodyDef def;
    def.shape = Sphere{0.5};
    def.mass = 2;
    def.pose.x = {x, 3, 0};
    world.add(def);
  }
  SpringDef spring;
  spring.bodies = {kWorldBody, 1};
  spring.anchors = {Vec3(0, 5, 0), Vec3(0, 0.5, 0)};
  spring.stiffness = 30;
  world.add(spring);
  return world;
}

struct State {
  std::vector<Pose> pose;
  std::vector<Velocity> velocity;
};
State stateOf(const World& world) { return {world.bodies().pose, world.bodies().velocity}; }

TEST(SetState, FindsTheContactsAtThesePosesBeforeAnyStep) {
  World world = makeBalls();
  State state = stateOf(world);
  ASSERT_TRUE(world.setState(state.pose, state.velocity));
  EXPECT_NEAR(world.largestOverlap(), 0.1, 1e-12);
  state.pose[2].x.x() = 1.25;
  ASSERT_TRUE(world.setState(state.pose, state.velocity));
  EXPECT_EQ(world.largestOverlap(), 0);
  state.pose[2].x.x() = 0.8;
  ASSERT_TRUE(world.setState(state.pose, state.velocity));
  EXPECT_NEAR(world.largestOverlap(), 0.2, 1e-12);
}

void expectGoesOn(World& world, World& restored) {
  restored.restore(world.saved());
  EXPECT_EQ(restored.contacts().size(), world.contacts().size());
  for (int k = 0; k < 3; ++k) {
    world.step();
    restored.step();
    EXPECT_EQ(stateHash(restored), stateHash(world)) << "step " << k;
  }
}

TEST(SavedWorld, GoesOnWithWhatTheNextStepIsGiven) {
  World world = makeBalls(), restored = makeBalls();
  for (int k = 0; k < 4; ++k) world.step();
  world.applyForce(2, Vec3(50, 0, 10), Vec3(0, 0, 3));
  world.setVelocity(1, {Vec3(0, 1, 0), Vec3(2, 0, 0)});
  expectGoesOn(world, restored);
}

TEST(SavedWorld, GoesOnFromAStateThatWasSet) {
  World world = makeBalls(), restored = makeBalls();
  for (int k = 0; k < 4; ++k) world.step();
  const State state = stateOf(makeBalls());
  ASSERT_TRUE(world.setState(state.pose, state.velocity));
  expectGoesOn(world, restored);
}

// A ball of 100 kg on a chain of 1 kg links swings into a column of boxes.
World makeSwing() {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  World world(settings);
  constexpr int kLinks = 6;
  const auto join = [&](BodyId a, BodyId b, const Vec3& at) {
    BallSocketDef joint;
    joint.bodies = {a, b};
    joint.at = at;
    joint.collide = false;
    world.add(joint);
  };
  BodyId last = kWorldBody;
  for (int k = 0; k < kLinks; ++k) {
    const BodyId link =
        testing::addBody(world, Box{Vec3(0.4, 0.1, 0.1)}, Vec3(-0.5 * k - 0.25, 3.6, 0), 1);
    join(last, link, Vec3(-0.5 * k, 3.6, 0));
    last = link;
  }
  const BodyId ball = testing::addBody(world, Sphere{0.4}, Vec3(-3.4, 3.6, 0), 100);
  join(last, ball, Vec3(-0.5 * kLinks, 3.6, 0));
  testing::addGround(world);
  for (int k = 0; k < 4; ++k) {
    testing::addBody(world, Box{Vec3(0.5, 0.5, 0.5)}, Vec3(0.7, 0.25 + 0.5 * k, 0), 2);
  }
  return world;
}

// Contacts see its joints where it hits, and after that no more.
TEST(SavedWorld, GoesOnWhereContactsSawJoints) {
  World world = makeSwing();
  for (int frame = 0; frame < 120; ++frame) {
    world.step();
    World restored = makeSwing();
    restored.restore(world.saved());
    restored.step();
    world.step();
    ASSERT_EQ(stateHash(restored), stateHash(world)) << "frame " << frame;
  }
}

// A joint that is open by 5 cm, and closed by no more than half a metre a second.
World makeOpen() {
  Settings settings;
  settings.maxCorrectionSpeed = 0.5;
  World world(settings);
  BallSocketDef joint;
  joint.bodies = {testing::addBody(world, Box{Vec3(0.2, 0.2, 0.2)}, Vec3(0, 0, 0), 1),
                  testing::addBody(world, Box{Vec3(0.2, 0.2, 0.2)}, Vec3(1.05, 0, 0), 1)};
  joint.anchors = {Vec3(0.5, 0, 0), Vec3(-0.5, 0, 0)};
  world.add(joint);
  return world;
}

TEST(SavedWorld, GoesOnWithAJointThatIsClosedSlowly) {
  World world = makeOpen(), restored = makeOpen();
  for (int k = 0; k < 3; ++k) world.step();
  expectGoesOn(world, restored);
}

TEST(SavedWorld, GoesOnInAWorldThatHasStepped) {
  World world = makeSwing(), restored = makeSwing();
  for (int k = 0; k < 60; ++k) restored.step();
  const State start = stateOf(makeSwing());
  ASSERT_TRUE(world.setState(start.pose, start.velocity));
  expectGoesOn(world, restored);
}

TEST(SavedWorld, OfOtherBodiesIsRefused) {
  World world = makeBalls(), other = makeBalls();
  other.add(BodyDef{});
  EXPECT_THROW(other.restore(world.saved()), std::invalid_argument);
  EXPECT_THROW(other.restore(""), std::invalid_argument);
}

TEST(SetState, MeasuresAsTheWorldThatWasSteppedThere) {
  World stepped = makeBalls(), told = makeBalls();
  for (int k = 0; k < 20; ++k) stepped.step();
  const State state = stateOf(stepped);
  ASSERT_TRUE(told.setState(state.pose, state.velocity));
  EXPECT_EQ(measure(told).total(), measure(stepped).total());
  EXPECT_EQ(measure(told).angularMomentum, measure(stepped).angularMomentum);
  EXPECT_NEAR(told.largestOverlap(), stepped.largestOverlap(), 1e-6);  // manifolds may be older
}

void expectNothingIsLeft(const Settings& settings) {
  World used = makeBalls(settings), fresh = makeBalls(settings);
  const State start = stateOf(used);
  for (int k = 0; k < 20; ++k) used.step();
  ASSERT_TRUE(used.setState(start.pose, start.velocity));
  ASSERT_TRUE(fresh.setState(start.pose, start.velocity));
  for (int k = 0; k < 20; ++k) used.step(), fresh.step();
  for (BodyId i = 1; i < used.bodyCount(); ++i) {
    EXPECT_EQ(used.bodies().pose[i].x, fresh.bodies().pose[i].x);
    EXPECT_EQ(used.bodies().velocity[i].w, fresh.bodies().velocity[i].w);
  }
}

TEST(SetState, LeavesNothingOfEarlierSteps) { expectNothingIsLeft({}); }

TEST(SetState, LeavesNothingOfEarlierStepsByAnAccuracy) {
  Settings settings;
  settings.accuracy = 1e-3;
  expectNothingIsLeft(settings);
}

// A can that stands on a block touches with all of its rim, of which a manifold has four points:
// which ones was told by where it leant before.
TEST(SetState, LeavesNoContactsOfEarlierPoses) {
  Settings settings;
  settings.contact = ContactSettings{};
  const auto make = [&settings] {
    World world(settings);
    BodyDef block, can;
    block.shape = Box{Vec3(2, 1, 2)};
    block.motion = Motion::kStatic;
    can.shape = Cylinder{0.5, 1};
    can.pose.x.y() = 1;
    can.mass = 1;
    world.add(block);
    world.add(can);
    return world;
  };
  const auto pointsOf = [](const World& world) {
    std::vector<Vec3> points;
    for (const ContactReport& contact : world.contacts()) points.push_back(contact.point);
    return points;
  };
  World fresh = make();
  const State upright = stateOf(fresh);
  ASSERT_TRUE(fresh.setState(upright.pose, upright.velocity));
  const std::vector<Vec3> expected = pointsOf(fresh);
  ASSERT_EQ(expected.size(), 4u);
  for (int k = 0; k < 8; ++k) {
    World world = make();
    State leaning = upright;
    const Vec3 axis(std::cos(k * kPi / 8), 0, std::sin(k * kPi / 8));
    leaning.pose[2].q = Quat(Eigen::AngleAxisd(2e-3, axis));
    ASSERT_TRUE(world.setState(leaning.pose, leaning.velocity));
    ASSERT_TRUE(world.setState(upright.pose, upright.velocity));
    EXPECT_EQ(pointsOf(world), expected) << k;
  }
}

TEST(SetState, RefusesWhatIsNotFiniteAndChangesNothing) {
  World world = makeBalls();
  const State before = stateOf(world);
  State state = before;
  state.pose[1].x.y() = 7;
  state.velocity[2].w.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(world.setState(state.pose, state.velocity));
  state.velocity[2].w.z() = 0;
  state.pose[2].q.coeffs().setZero();
  EXPECT_FALSE(world.setState(state.pose, state.velocity));
  EXPECT_EQ(world.bodies().pose[1].x, before.pose[1].x);
  state.pose.pop_back();
  EXPECT_THROW(world.setState(state.pose, state.velocity), std::invalid_argument);
}

TEST(SetState, LeavesTheWorldBodyWhereItIs) {
  World world = makeBalls();
  State state = stateOf(world);
  state.pose[kWorldBody].x = {1, 2, 3};
  ASSERT_TRUE(world.setState(state.pose, state.velocity));
  EXPECT_EQ(world.bodies().pose[kWorldBody].x, Vec3::Zero());
}

TEST(Constraints, AreToldAsValuesWithTheirWords) {
  World world = makeBalls();
  DistanceDef distance;
  distance.bodies = {1, 2};
  distance.collide = false;
  world.add(distance);
  const std::vector<ConstraintItem> items = world.constraints();
  ASSERT_EQ(items.size(), 2u);
  EXPECT_STREQ(items[0].kind, "spring");
  EXPECT_EQ(std::get<Spring>(items[0].item).stiffness, 30);
  EXPECT_NEAR(std::get<Spring>(items[0].item).restLength, 1.5, 1e-12);
  EXPECT_STREQ(items[1].kind, "distance");
  EXPECT_NEAR(std::get<Distance>(items[1].item).length, 0.9, 1e-12);
  EXPECT_EQ(world.ignoredPairs(), (std::vector<std::array<BodyId, 2>>{{1, 2}}));
}

}  // namespace
}  // namespace physics
