// Numbers that stop being finite at step 100, for every method, stepping and kind of body: told in
// that step, with the world as it was before.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/make/rope.h"
#include "physics/make/soft_body.h"
#include "physics/world/measure.h"
#include "physics/world/state.h"
#include "tests/physics/arms.h"
#include "tests/physics/not_a_number.h"

namespace physics::testing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Way {
  const char* name;
  Method method;
  Stepping stepping;
};
void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

constexpr Way kWays[] = {
    {"nonlinear_paper", Method::kNonlinearGaussSeidel, Stepping::kPaper},
    {"nonlinear_static", Method::kNonlinearGaussSeidel, Stepping::kStatic},
    {"nonlinear_bdf2", Method::kNonlinearGaussSeidel, Stepping::kBdf2},
    {"nonlinear_symmetric", Method::kNonlinearGaussSeidel, Stepping::kSymmetric},
    {"direct_paper", Method::kDirect, Stepping::kPaper},
    {"direct_bdf2", Method::kDirect, Stepping::kBdf2},
    {"direct_symmetric", Method::kDirect, Stepping::kSymmetric},
    {"linear", Method::kLinearGaussSeidel, Stepping::kPaper},
    {"xpbd", Method::kXpbd, Stepping::kPaper},
    {"sequential_impulses", Method::kSequentialImpulses, Stepping::kPaper},
    {"penalty", Method::kPenalty, Stepping::kPaper},
    {"penalty_explicit", Method::kPenaltyExplicit, Stepping::kPaper},
};

// One of everything: boxes on the ground, a pendulum of two, a rope, a soft body, an arm.
struct Everything {
  World world;
  BodyId box = 0, link = 0, node = 0, corner = 0;

  explicit Everything(const Way& way) : world(settingsOf(way)) {
    BodyDef def;
    def.shape = Plane{};
    def.motion = Motion::kStatic;
    world.add(def);
    def = {};
    def.shape = Box{Vec3(0.4, 0.3, 0.5)};
    for (const double y : {0.15, 0.46}) def.pose.x = Vec3(3, y, 0), box = world.add(def);
    BallSocketDef joint;
    joint.bodies[1] = kWorldBody;
    for (const double x : {0.2, 0.6}) {
      joint.at = Vec3(x - 0.2, 3, 0);
      def.pose.x = Vec3(x, 3, 0);
      joint.bodies = {joint.bodies[1], link = world.add(def)};
      world.add(joint);
    }
    RopeDef rope;
    rope.from = Vec3(0, 3, 2);
    rope.to = Vec3(1, 3, 2);
    rope.count = 4;
    rope.pins = RopePins::kStart;
    node = add(world, rope)[2];
    SoftBodyDef soft;
    soft.box = TetBox{Vec3::Constant(0.4), {1, 1, 1}};
    soft.place.position = Vec3(-3, 0.3, 0);
    corner = add(world, soft).nodes[3];
    ArmDef arm = planarArm(0.05, 3);
    arm.at = Vec3(0, 1, -3);
    arm.target = Vec3(0.4, 1.5, -3);
    world.add(arm);
  }

  static Settings settingsOf(const Way& way) {
    Settings settings;
    settings.method = way.method;
    settings.stepping = way.stepping;
    settings.gravity = Vec3(0, -9.81, 0);
    settings.contact = ContactSettings{};
    return settings;
  }
};

class NotFiniteAtStep100 : public ::testing::TestWithParam<Way> {
 protected:
  // After `harm` the step names `body`, nothing has moved, and the next steps are good.
  template <class Harm>
  void expectTold(BodyId Everything::*body, Harm harm) {
    Everything all(GetParam());
    for (int k = 0; k < 99; ++k) ASSERT_FALSE(all.world.step().notFinite) << "step " << k + 1;
    const std::uint64_t before = stateHash(all.world);
    const Vec3 tip = all.world.arms()[0].tip;
    harm(all.world, all.*body);
    const StepReport report = all.world.step();
    ASSERT_TRUE(report.notFinite);
    EXPECT_EQ(report.notFinite->body, all.*body);
    EXPECT_EQ(report.notFinite->substep, 0);
    EXPECT_EQ(stateHash(all.world), before);  // bit for bit, the count of steps as well
    EXPECT_EQ(all.world.arms()[0].tip, tip);
    EXPECT_EQ(all.world.stepCount(), 99);
    for (int k = 0; k < 5; ++k) EXPECT_FALSE(all.world.step().notFinite) << "after it";
  }
};

constexpr BodyId Everything::*kBodies[] = {&Everything::box, &Everything::link, &Everything::node,
                                           &Everything::corner};

TEST_P(NotFiniteAtStep100, AVelocityIsTold) {
  for (const auto body : kBodies) {
    expectTold(body, [](World& world, BodyId b) {
      world.setVelocity(b, {Vec3(0, kNaN, 0), Vec3::Zero()});
      world.setVelocity(b, {Vec3(kInfinite, 0, 0), Vec3::Zero()});
    });
  }
}

TEST_P(NotFiniteAtStep100, AForceIsTold) {
  for (const auto body : kBodies) {
    expectTold(body, [](World& world, BodyId b) {
      world.applyForce(b, Vec3(0, 0, -kInfinite), Vec3::Zero());
    });
  }
}

TEST_P(NotFiniteAtStep100, ATorqueIsTold) {
  expectTold(&Everything::link,
             [](World& world, BodyId b) { world.applyForce(b, Vec3::Zero(), Vec3(kNaN, 0, 0)); });
}

// Finite when it is set; its square is not: found by whoever squares it first.
TEST_P(NotFiniteAtStep100, AVelocityThatOverflowsInTheStepIsToldWithAConstraint) {
  if (GetParam().stepping == Stepping::kStatic) GTEST_SKIP() << "velocities are not used";
  Everything all(GetParam());
  for (int k = 0; k < 99; ++k) all.world.step();
  const Bodies before = all.world.bodies();
  all.world.setVelocity(all.link, {Vec3(0, 1e200, 0), Vec3::Zero()});
  const StepReport report = all.world.step();
  ASSERT_TRUE(report.notFinite);
  EXPECT_EQ(report.notFinite->constraint.rfind("ball_socket ", 0), 0u)
      << report.notFinite->constraint;
  for (BodyId b = 0; b < all.world.bodyCount(); ++b) {
    EXPECT_EQ(all.world.bodies().pose[b].x, before.pose[b].x);
    EXPECT_TRUE(all.world.bodies().velocity[b].v.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, NotFiniteAtStep100, ::testing::ValuesIn(kWays),
                         [](const auto& way) { return std::string(way.param.name); });

TEST(NotFinite, AStateIsRefusedWithItsBody) {
  Everything all(kWays[0]);
  std::vector<Pose> poses = all.world.bodies().pose;
  std::vector<Velocity> velocities = all.world.bodies().velocity;
  EXPECT_EQ(firstNotFinite(poses, velocities), -1);
  poses[all.node].x.y() = kNaN;
  const std::uint64_t before = stateHash(all.world);
  EXPECT_FALSE(all.world.setState(poses, velocities));
  EXPECT_EQ(firstNotFinite(poses, velocities), all.node);
  EXPECT_EQ(stateHash(all.world), before);
}

TEST(NotFinite, AVelocityThatIsSetAgainBeforeTheStepDoesNoHarm) {
  Everything all(kWays[0]);
  all.world.setVelocity(all.box, {Vec3(kNaN, 0, 0), Vec3::Zero()});
  all.world.setVelocity(all.box, {Vec3(0, 1, 0), Vec3::Zero()});
  EXPECT_FALSE(all.world.step().notFinite);
  EXPECT_GT(all.world.bodies().velocity[all.box].v.y(), 0.5);
}

}  // namespace
}  // namespace physics::testing
