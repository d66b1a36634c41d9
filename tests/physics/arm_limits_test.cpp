// Arms where the numbers are awkward: limits, straight chains, targets out of reach, at the root.
#include <gtest/gtest.h>

#include "tests/physics/arms.h"

namespace physics::testing {
namespace {

ArmDef tolerantArm(double angle = 0.05, int count = 6) {
  ArmDef def = planarArm(angle, count);
  def.solve = ArmSolve{};
  return def;
}

ArmDef ballArm(double angle, int count = 6) {
  ArmDef def = tolerantArm(angle, count);
  for (ArmLinkDef& link : def.links) link.hinge = false;
  return def;
}

bool isFinite(const Arm& arm) {
  const ArmPosture posture = postureOf(arm);
  bool finite = posture.tip.allFinite();
  for (const Quat& q : posture.q) finite = finite && q.coeffs().allFinite();
  return finite;
}

TEST(Arm, ComesAsNearAsItCanToATargetOutOfReachAndStaysThere) {
  for (ArmForm form : {ArmForm::kMassWeighted, ArmForm::kPseudoInverse}) {
    ArmDef def = tolerantArm();
    def.solve.form = form;
    Arm arm = makeArm(def);
    const Vec3 target = 1.3 * Vec3(std::cos(0.5), std::sin(0.5), 0);
    ArmScratch scratch;
    double before = errorOf(arm, target);
    for (int k = 0; k < 2000; ++k) {
      iterate(arm, target, def.solve, scratch);
      ASSERT_LE(errorOf(arm, target), before);  // never away from it
      before = errorOf(arm, target);
    }
    EXPECT_NEAR(before, 0.3, 1e-5);
  }
}

TEST(Arm, ThrashesAtATargetOutOfReachWithoutRegularisation) {  // NOTES 3.10: .445
  const ArmDef def = planarArm();
  Arm arm = makeArm(def);
  const Vec3 target = 1.3 * Vec3(std::cos(0.5), std::sin(0.5), 0);
  reach(arm, target, def.solve, 200, 1e-3);
  EXPECT_NEAR(errorOf(arm, target), 0.445, 0.005);
}

TEST(Arm, BendsAsideWhenItIsStraightAlongTheError) {
  for (const Vec3& target : {Vec3(0.5, 0, 0), Vec3(-0.7, 0, 0), Vec3(0.97, 0, 0)}) {
    for (const ArmDef& def : {tolerantArm(0), ballArm(0), tolerantArm(0, 5), ballArm(0, 3)}) {
      Arm arm = makeArm(def);
      reach(arm, target, def.solve, 1000, 1e-9);
      EXPECT_LT(errorOf(arm, target), 1e-9) << target.transpose() << ", " << arm.size();
    }
  }
}

TEST(Arm, ReachesForItsRoot) {
  for (const ArmDef& def : {tolerantArm(0), tolerantArm(0.3), ballArm(0), ballArm(0.3)}) {
    Arm arm = makeArm(def);
    reach(arm, Vec3::Zero(), def.solve, 1000, 1e-9);
    EXPECT_LT(errorOf(arm, Vec3::Zero()), 1e-9);
  }
}

TEST(Arm, TurnsAboutWhenItPointsAwayFromATargetOutOfReach) {
  const ArmDef def = ballArm(0);
  Arm arm = makeArm(def);
  const Vec3 target(-1.3, 0, 0);
  reach(arm, target, def.solve, 3000, 0.3);
  EXPECT_NEAR(errorOf(arm, target), 0.3, 1e-4);
}

TEST(Arm, StaysWhereItIsNearestEvenWithoutAGradient) {
  const Vec3 above(0.4, 0.1, 0.6);  // hinges keep the tip in z = 0
  ArmDef def = tolerantArm(0.3);
  Arm arm = makeArm(def);
  reach(arm, above, def.solve, 1000, 0.6 + 1e-9);
  EXPECT_NEAR(errorOf(arm, above), 0.6, 1e-8);
  const std::vector<ArmJoint> there = arm.joints;
  ArmScratch scratch;
  for (int k = 0; k < 50; ++k) iterate(arm, above, def.solve, scratch);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(arm.joints[k].angle, there[k].angle, 1e-3);
}

TEST(Arm, IsFiniteWhateverTheTarget) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    ArmDef def = randomArm(random, 1 + trial % 5);
    def.solve.regularisation = trial % 2 == 0 ? 0 : 0.01;
    Arm arm = makeArm(def);
    ArmScratch scratch;
    const ArmPosture posture = postureOf(arm);
    const Vec3 targets[] = {arm.root, posture.tip, posture.pivot.back(), Vec3(1e9, 0, 0),
                            posture.tip + 1e-300 * Vec3::UnitX()};
    for (const Vec3& target : targets) {
      for (int k = 0; k < 20; ++k) iterate(arm, target, def.solve, scratch);
      ASSERT_TRUE(isFinite(arm));
    }
  }
}

TEST(Arm, KeepsHingesWithinTheirRange) {
  ArmDef def = tolerantArm();
  for (ArmLinkDef& link : def.links) link.range = {-0.4, 0.1};
  Arm arm = makeArm(def);
  ArmScratch scratch;
  const Vec3 target(0.3, 0.6, 0);
  for (int k = 0; k < 300; ++k) {
    iterate(arm, target, def.solve, scratch);
    for (const ArmJoint& joint : arm.joints) {
      ASSERT_LE(joint.angle, 0.1);
      ASSERT_GE(joint.angle, -0.4);
    }
  }
  for (const ArmJoint& joint : arm.joints) EXPECT_EQ(joint.angle, 0.1);  // as far up as they go
}

TEST(Arm, ReachesWithTheOtherJointsWhereSomeAreAtTheirLimit) {
  ArmDef def = tolerantArm();
  def.links[4].range = def.links[5].range = {-0.1, 0.1};  // those that would bend most
  Arm arm = makeArm(def);
  const Vec3 target(0.5, 0.5, 0);
  reach(arm, target, def.solve, 200, 1e-9);
  EXPECT_LT(errorOf(arm, target), 1e-9);
  EXPECT_LE(std::abs(arm.joints[5].angle), 0.1);
}

double bendOf(const Arm& arm, const ArmPosture& posture, int k) {
  const Quat& parent = parentOf(arm, posture, k);
  const Vec3 before = parent * arm.links[std::max(k - 1, 0)].direction;
  const Vec3 own = posture.q[k] * arm.links[k].direction;
  return std::acos(std::min(1.0, before.dot(own)));
}

TEST(Arm, KeepsBallsWithinTheirBend) {
  ArmDef def = ballArm(0.05);
  for (ArmLinkDef& link : def.links) link.bend = 0.5;
  Arm arm = makeArm(def);
  const Vec3 target(0.25, 0.4, 0.6);  // bends of .42 bring the tip as near to the root
  ArmScratch scratch;
  for (int i = 0; i < 500; ++i) {
    iterate(arm, target, def.solve, scratch);
    const ArmPosture posture = postureOf(arm);
    for (int k = 0; k < 6; ++k) ASSERT_LE(bendOf(arm, posture, k), 0.5 + 1e-7);  // of acos
  }
  EXPECT_LT(errorOf(arm, target), 1e-9);
}

}  // namespace
}  // namespace physics::testing
