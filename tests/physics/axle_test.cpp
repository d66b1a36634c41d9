// Axle, (80)-(87): closing from far away, in both forms.
#include "physics/constraints/axle.h"

#include <gtest/gtest.h>

#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

// Axis x in both bodies.
Axle axleAlongX(Form form) {
  Mat3 frame;
  frame.col(0) = Vec3::UnitY();
  frame.col(1) = Vec3::UnitZ();
  frame.col(2) = Vec3::UnitX();
  return {{0, 1}, Vec3::UnitX(), frame, form};
}

double angle(const Bodies& bodies) {
  return angleOf(bodies.pose[0].q * Vec3::UnitX(), bodies.pose[1].q * Vec3::UnitX());
}

// The bodies' x axes an angle apart in the x-y plane; z is a principal axis of both.
Bodies planar(double apart) {
  return bodiesOf({{1, Vec3(0.3, 0.4, 0.5), {Vec3::Zero(), about({0, 0, 1}, 0.3)}},
                   {2, Vec3(0.9, 0.7, 0.6), {Vec3::Zero(), about({0, 0, 1}, 0.3 + apart)}}});
}

Bodies askew(double apart) {
  const Quat tilt = about({1, -2, 0.5}, 0.8), spin = about({1, 0, 0}, 1.9);
  return bodiesOf(
      {{1, Vec3(0.3, 0.4, 0.5), {Vec3::Zero(), tilt}},
       {2, Vec3(0.9, 0.7, 0.3), {Vec3::Zero(), tilt * about({0, 1, 1}, apart) * spin}}});
}

class AxleForm : public ::testing::TestWithParam<Form> {};
INSTANTIATE_TEST_SUITE_P(Axle, AxleForm, ::testing::Values(Form::kVector, Form::kScalar),
                         [](const auto& info) { return names(Form{})[int(info.param)]; });

TEST_P(AxleForm, ClosesInOneIterationFromFortyDegreesInThePlane) {
  Bodies bodies = planar(40 * kDegree);
  iterate(axleAlongX(GetParam()), bodies, 1);
  EXPECT_LE(angle(bodies), 1e-10);
}

TEST_P(AxleForm, ClosesInOneIterationFromHundredAndTwentyDegreesInThePlane) {
  Bodies bodies = planar(120 * kDegree);
  iterate(axleAlongX(GetParam()), bodies, 1);
  EXPECT_LE(angle(bodies), 1e-10);
}

TEST_P(AxleForm, ClosesFromAnyAngleWithTiltedInertias) {
  for (const double degrees : {1.0, 50.0, 90.0, 140.0, 179.0}) {
    Bodies bodies = askew(degrees * kDegree);
    iterate(axleAlongX(GetParam()), bodies, 60);
    EXPECT_LE(angle(bodies), 1e-10) << degrees;
  }
}

TEST_P(AxleForm, LeavesTheTurnAboutTheAxleFree) {
  Bodies bodies = planar(0);
  bodies.pose[1].q = bodies.pose[1].q * about({1, 0, 0}, 1.3);
  const Quat before = bodies.pose[1].q;
  iterate(axleAlongX(GetParam()), bodies, 5);
  EXPECT_LT(before.angularDistance(bodies.pose[1].q), 1e-15);
}

TEST_P(AxleForm, SharesTheTurnByTheInverseInertias) {
  Bodies bodies = planar(40 * kDegree);
  const Quat before = bodies.pose[0].q;
  iterate(axleAlongX(GetParam()), bodies, 1);
  // I about z: 0.5 and 0.6; body i turns by 0.6/1.1 of the way.
  EXPECT_NEAR(before.angularDistance(bodies.pose[0].q), 40 * kDegree * 0.6 / 1.1, 1e-12);
}

// Swapped, the vector form measures across the other body's axis: the same to first order only.
TEST(Axle, VectorFormAgreesWithItsSwappedSelfToFirstOrder) {
  for (const double apart : {1e-2, 1e-3}) {
    Bodies bodies = askew(apart), other = bodies;
    Axle item = axleAlongX(Form::kVector), swapped = item;
    std::swap(swapped.bodies[0], swapped.bodies[1]);
    iterate(item, bodies, 1);
    iterate(swapped, other, 1);
    EXPECT_LT(bodies.pose[0].q.angularDistance(other.pose[0].q), apart * apart);
  }
}

}  // namespace
}  // namespace physics::testing
