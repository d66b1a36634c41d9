// What a World refuses, each with std::invalid_argument.
#include <gtest/gtest.h>

#include <functional>

#include "physics/world.h"
#include "tests/physics/not_a_number.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expectRefused(const char* what, const std::function<void(Settings&)>& spoil) {
  Settings settings;
  settings.contact = ContactSettings{};
  spoil(settings);
  EXPECT_THROW(World{settings}, std::invalid_argument) << what;
}

TEST(Refuses, SenselessSettings) {
  for (const double dt : {0.0, -1.0, kNaN, kInfinity}) {
    expectRefused("dt", [=](Settings& s) { s.dt = dt; });
  }
  expectRefused("substeps", [](Settings& s) { s.substeps = 0; });
  expectRefused("iterations", [](Settings& s) { s.iterations = 0; });
  for (const double xi : {0.0, 2.0, -1.0, kNaN}) {
    expectRefused("relaxation", [=](Settings& s) { s.relaxation = xi; });
  }
  for (const double epsilon : {-1e-9, kNaN, kInfinity}) {
    expectRefused("regularisation", [=](Settings& s) { s.regularisation = epsilon; });
  }
  expectRefused("gravity", [](Settings& s) { s.gravity = Vec3(0, kNaN, 0); });
}

TEST(Refuses, SenselessContactSettings) {
  expectRefused("friction", [](Settings& s) { s.contact->friction = {0.3, 0.5}; });
  expectRefused("friction", [](Settings& s) { s.contact->friction = {0.3, -0.1}; });
  expectRefused("friction", [](Settings& s) { s.contact->friction = {kNaN, 0}; });
  expectRefused("restitution", [](Settings& s) { s.contact->restitution = 1.1; });
  expectRefused("restitution", [](Settings& s) { s.contact->restitution = kNaN; });
  expectRefused("speed", [](Settings& s) { s.contact->maxSeparationSpeed = 0; });
  expectRefused("margin", [](Settings& s) { s.contact->margin = -1; });
  expectRefused("margin", [](Settings& s) { s.contact->margin = kNaN; });
}

void expectBodyRefused(const char* what, const std::function<void(BodyDef&)>& spoil) {
  World world;
  BodyDef def;
  def.shape = Box{};
  spoil(def);
  EXPECT_THROW(world.add(def), std::invalid_argument) << what;
  EXPECT_EQ(world.bodyCount(), 1) << what;
}

TEST(Refuses, SenselessBodies) {
  for (const double mass : {0.0, -1.0, kNaN, kInfinity}) {
    expectBodyRefused("mass", [=](BodyDef& d) { d.mass = mass; });
  }
  expectBodyRefused("triangle rule", [](BodyDef& d) { d.inertia = Vec3(1, 1, 2.1); });
  expectBodyRefused("negative inertia", [](BodyDef& d) { d.inertia = Vec3(-1, 1, 1); });
  expectBodyRefused("inertia", [](BodyDef& d) { d.inertia = Vec3(1, kNaN, 1); });
  expectBodyRefused("zero quaternion", [](BodyDef& d) { d.pose.q = Quat(0, 0, 0, 0); });
  expectBodyRefused("orientation", [](BodyDef& d) { d.pose.q = Quat(1, kNaN, 0, 0); });
  expectBodyRefused("place", [](BodyDef& d) { d.pose.x.x() = kInfinity; });
  expectBodyRefused("velocity", [](BodyDef& d) { d.velocity.v.x() = kNaN; });
  expectBodyRefused("spin", [](BodyDef& d) { d.velocity.w.x() = kNaN; });
  expectBodyRefused("moving plane", [](BodyDef& d) { d.shape = Plane{}; });
}

TEST(Refuses, SenselessFrictionOfABody) {
  expectBodyRefused("friction", [](BodyDef& d) { d.friction = Friction{0.1, 0.2}; });
}

template <class Def>
void expectJointRefused(const char* what, const std::function<void(Def&)>& spoil) {
  World world;
  BodyDef body;
  body.shape = Box{};
  world.add(body);
  world.add(body);
  Def def;
  def.bodies = {1, 2};
  spoil(def);
  EXPECT_THROW(world.add(def), std::invalid_argument) << Def::kWord << ": " << what;
}

template <class Def>
class EveryDef : public ::testing::Test {};
using Defs = ::testing::Types<BallSocketDef, AxleDef, ConeLimitDef, TwistLimitDef, DistanceDef,
                              SpringDef, DriveDef, MotorDef, PointOnLineDef, SlideLimitDef,
                              OrientationLockDef, PerpendicularDef>;
TYPED_TEST_SUITE(EveryDef, Defs);

TYPED_TEST(EveryDef, IsRefusedBetweenABodyAndItself) {
  expectJointRefused<TypeParam>("itself", [](TypeParam& d) { d.bodies = {1, 1}; });
}

TYPED_TEST(EveryDef, IsRefusedForABodyThatIsNotThere) {
  expectJointRefused<TypeParam>("too large", [](TypeParam& d) { d.bodies = {1, 3}; });
  expectJointRefused<TypeParam>("negative", [](TypeParam& d) { d.bodies = {-1, 1}; });
}

TEST(Refuses, AxesThatAreZeroOrNotFinite) {
  for (const Vec3& n : {Vec3(0, 0, 0), Vec3(kNaN, 0, 0)}) {
    expectJointRefused<AxleDef>("axis", [=](AxleDef& d) { d.axis = n; });
    expectJointRefused<ConeLimitDef>("axis", [=](ConeLimitDef& d) { d.axis = n; });
    expectJointRefused<TwistLimitDef>("axis", [=](TwistLimitDef& d) { d.axis = n; });
    expectJointRefused<MotorDef>("axis", [=](MotorDef& d) { d.axis = n; });
    expectJointRefused<PointOnLineDef>("axis", [=](PointOnLineDef& d) { d.axis = n; });
    expectJointRefused<SlideLimitDef>("axis", [=](SlideLimitDef& d) { d.axis = n; });
    expectJointRefused<PerpendicularDef>("axis", [=](PerpendicularDef& d) { d.directions[1] = n; });
  }
}

TEST(Refuses, SenselessLimitsAndLengths) {
  expectJointRefused<ConeLimitDef>("negative", [](ConeLimitDef& d) { d.angle = -0.1; });
  expectJointRefused<ConeLimitDef>("too wide", [](ConeLimitDef& d) { d.angle = 3.2; });
  expectJointRefused<TwistLimitDef>("order", [](TwistLimitDef& d) { d.range = {0.2, 0.1}; });
  expectJointRefused<TwistLimitDef>("too wide", [](TwistLimitDef& d) { d.range = {-4, 0.1}; });
  expectJointRefused<SlideLimitDef>("order", [](SlideLimitDef& d) { d.range = {0.2, 0.1}; });
  expectJointRefused<SlideLimitDef>("finite", [](SlideLimitDef& d) { d.range = {0, kInfinity}; });
  expectJointRefused<DistanceDef>("length", [](DistanceDef& d) { d.length = -1; });
  expectJointRefused<DistanceDef>("length", [](DistanceDef& d) { d.length = kNaN; });
}

TEST(Refuses, SenselessForces) {
  expectJointRefused<SpringDef>("stiffness", [](SpringDef& d) { d.stiffness = -1; });
  expectJointRefused<SpringDef>("damping", [](SpringDef& d) { d.damping = kNaN; });
  expectJointRefused<SpringDef>("rest", [](SpringDef& d) { d.restLength = -1; });
  expectJointRefused<DriveDef>("stiffness", [](DriveDef& d) { d.stiffness = kNaN; });
  expectJointRefused<DriveDef>("torque", [](DriveDef& d) { d.maxTorque = -1; });
  expectJointRefused<DriveDef>("target", [](DriveDef& d) { d.target = Quat(0, 0, 0, 0); });
  expectJointRefused<MotorDef>("speed", [](MotorDef& d) { d.speed = kNaN; });
  expectJointRefused<MotorDef>("torque", [](MotorDef& d) { d.maxTorque = -1; });
}

TEST(Refuses, AnOrientationThatIsNone) {
  expectJointRefused<OrientationLockDef>(
      "orientation", [](OrientationLockDef& d) { d.orientation = Quat(0, 0, 0, 0); });
}

TEST(Refuses, AnchorsThatAreNotFinite) {
  expectJointRefused<BallSocketDef>("at", [](BallSocketDef& d) { d.at.x() = kNaN; });
  expectJointRefused<SpringDef>("anchor", [](SpringDef& d) { d.anchors[0].x() = kNaN; });
}

TEST(Refuses, BodiesThatAreNotThereBetweenSteps) {
  World world;
  EXPECT_THROW(world.setVelocity(1, {}), std::invalid_argument);
  EXPECT_THROW(world.applyForce(kWorldBody, {}, {}), std::invalid_argument);
  EXPECT_THROW(world.setDriveTarget(0, Quat::Identity()), std::invalid_argument);
  EXPECT_THROW(world.driveTorque(0), std::invalid_argument);
}

}  // namespace
}  // namespace physics::testing
