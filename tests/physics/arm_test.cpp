// Arms: gradient, inertia and composition of turns against independent computations; figure 10.
#include <gtest/gtest.h>

#include "physics/kinematics/pseudo_inverse.h"
#include "tests/physics/arms.h"

namespace physics::testing {
namespace {

TEST(Arm, GradientEqualsCentralDifferences) {
  Random random(1);
  constexpr double kStep = 1e-5;
  for (int trial = 0; trial < 20; ++trial) {
    const Arm arm = makeArm(randomArm(random, 5));
    const ArmPosture posture = postureOf(arm);
    const Vec3 target = arm.root + randomVector(random);
    const TipError error = tipError(posture, target);
    for (int k = 0; k < arm.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 turn = kStep * Vec3::Unit(axis);
        const double difference = ((tipAfter(posture, k, turn) - target).norm() -
                                   (tipAfter(posture, k, -turn) - target).norm()) /
                                  (2 * kStep);
        // O(step^2) = 1e-10 and rounding 1e-16 / step = 1e-11
        EXPECT_NEAR(gradientOf(posture, k, error.n)[axis], difference, 1e-8);
      }
    }
  }
}

// Velocity of centre of mass i per unit turn of joint k, and the turn itself.
Eigen::MatrixXd bodyJacobian(const ArmPosture& posture, int i) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(6, 3 * static_cast<int>(posture.q.size()));
  for (int k = 0; k <= i; ++k) {
    j.block<3, 3>(0, 3 * k) = -skew(posture.centre[i] - posture.pivot[k]);
    j.block<3, 3>(3, 3 * k) = Mat3::Identity();
  }
  return j;
}

// The joint-space mass matrix as the sum of J_i^T diag(m_i, I_i) J_i over the bodies.
Eigen::MatrixXd massMatrix(const Arm& arm, const ArmPosture& posture) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3 * arm.size(), 3 * arm.size());
  for (int i = 0; i < arm.size(); ++i) {
    const Mat3 rotation = posture.q[i].toRotationMatrix();
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(6, 6);
    own.topLeftCorner<3, 3>() = arm.links[i].mass * Mat3::Identity();
    own.bottomRightCorner<3, 3>() = rotation * arm.links[i].inertia * rotation.transpose();
    const Eigen::MatrixXd j = bodyJacobian(posture, i);
    sum += j.transpose() * own * j;
  }
  return sum;
}

TEST(Arm, InertiaOfAPivotIsTheDiagonalBlockOfTheMassMatrix) {
  Random random(2);
  for (int trial = 0; trial < 10; ++trial) {
    const Arm arm = makeArm(randomArm(random, 7));
    const ArmPosture posture = postureOf(arm);
    const Eigen::MatrixXd whole = massMatrix(arm, posture);
    std::vector<Mat3> inertia;
    pivotInertias(arm, posture, inertia);
    for (int k = 0; k < arm.size(); ++k) {
      EXPECT_LT((inertia[k] - whole.block<3, 3>(3 * k, 3 * k)).norm(), 1e-12 * whole.norm());
    }
  }
}

TEST(Arm, EffortIsThatOfTheWholeMassMatrix) {
  Random random(3);
  const Arm arm = makeArm(randomArm(random, 6));
  const ArmPosture posture = postureOf(arm);
  std::vector<Vec3> turns;
  Eigen::VectorXd all(18);
  for (int k = 0; k < 6; ++k)
    turns.push_back(randomVector(random)), all.segment<3>(3 * k) = turns[k];
  const double expected = 0.5 * all.dot(massMatrix(arm, posture) * all);
  EXPECT_NEAR(effortOf(arm, posture, turns), expected, 1e-12 * expected);
}

TEST(Arm, TurnsOfAllJointsCarryEverythingBeyondThem) {
  Random random(4);
  Arm arm = makeArm(randomArm(random, 6));
  const ArmPosture before = postureOf(arm);
  ArmPosture expected = before;  // turned one after the other, from the tip to the root
  for (int k = 5; k >= 0; --k) {
    const Vec3 axis = parentOf(arm, before, k) * arm.links[k].axis;
    const Vec3 turn = arm.links[k].hinge ? Vec3(0.7 * axis) : Vec3(randomVector(random));
    for (int i = k; i < 6; ++i) {
      expected.q[i] = exponential(turn) * expected.q[i];
      expected.pivot[i] =
          before.pivot[k] + exponential(turn) * (expected.pivot[i] - before.pivot[k]);
    }
    expected.tip = before.pivot[k] + exponential(turn) * (expected.tip - before.pivot[k]);
    turnJoint(arm, before, k, turn, arm.joints[k]);
  }
  const ArmPosture after = postureOf(arm);
  EXPECT_LT((after.tip - expected.tip).norm(), 1e-14);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(logarithm(after.q[i] * expected.q[i].conjugate()).norm(), 1e-14);
    EXPECT_LT((after.pivot[i] - expected.pivot[i]).norm(), 1e-14);
  }
}

TEST(Arm, PseudoInverseFormTakesTheLeastStep) {
  Random random(5);
  ArmDef def = randomArm(random, 5);
  for (ArmLinkDef& link : def.links) link.hinge = false;
  def.solve = planarArm().solve;
  def.solve.form = ArmForm::kPseudoInverse;
  Arm arm = makeArm(def);
  const ArmPosture posture = postureOf(arm);
  const Vec3 target = posture.tip + Vec3(0.05, 0.1, -0.02);
  const TipError error = tipError(posture, target);
  Eigen::MatrixXd j(1, 15);
  for (int k = 0; k < 5; ++k) j.block<1, 3>(0, 3 * k) = gradientOf(posture, k, error.n).transpose();
  const Eigen::VectorXd least = leastStep(j, Eigen::VectorXd::Constant(1, error.c));
  ArmScratch scratch;
  iterate(arm, target, def.solve, scratch);
  for (int k = 0; k < 5; ++k) {
    EXPECT_LT((scratch.turns[k] - least.segment<3>(3 * k)).norm(), 1e-13);
  }
}

struct Figure10 {
  Vec3 target;
  ArmForm form;
  double last, first, effort;  // shares of the last and first two joints; NOTES, figure 10
  int iterations;              // to 1e-3, 60 at the most
};

class ArmFigure10 : public ::testing::TestWithParam<Figure10> {};

TEST_P(ArmFigure10, BendsWhereNotesMeasuredIt) {
  const Figure10& expected = GetParam();
  ArmDef def = planarArm();
  def.solve.form = expected.form;
  Arm arm = makeArm(def);
  ArmScratch scratch;
  int count = 0;
  double effort = 0;
  for (; count < 60 && errorOf(arm, expected.target) >= 1e-3; ++count) {
    effort += iterate(arm, expected.target, def.solve, scratch).effort;
  }
  double sum = 0, last = 0, first = 0;
  for (int k = 0; k < 6; ++k) {
    const double change = std::abs(arm.joints[k].angle - 0.05);
    sum += change, last += k >= 4 ? change : 0, first += k < 2 ? change : 0;
  }
  EXPECT_EQ(count, expected.iterations);
  EXPECT_NEAR(last / sum, expected.last, 0.005);
  EXPECT_NEAR(first / sum, expected.first, 0.005);
  EXPECT_NEAR(effort, expected.effort, 0.005 * std::max(1.0, effort));
}

constexpr ArmForm kWeighted = ArmForm::kMassWeighted, kPseudo = ArmForm::kPseudoInverse;
INSTANTIATE_TEST_SUITE_P(Targets, ArmFigure10,
                         ::testing::Values(  //
                             Figure10{{.8, .45, 0}, kWeighted, .72, .09, .039, 9},
                             Figure10{{.5, .5, 0}, kWeighted, .75, .07, .186, 7},
                             Figure10{{.9, -.2, 0}, kWeighted, .81, .06, .059, 12},
                             Figure10{{.8, .45, 0}, kPseudo, .36, .17, .413, 19},
                             Figure10{{.5, .5, 0}, kPseudo, .38, .17, 2.13, 17},
                             Figure10{{.9, -.2, 0}, kPseudo, .32, .21, 1.77, 60}));

TEST(PseudoInverse, OfARowIsTheRowOverItsSquare) {  // (144)
  const Eigen::RowVector3d a(1, -2, 4);
  EXPECT_LT((pseudoInverse(a) - a.transpose() / 21).norm(), 1e-15);
}

TEST(PseudoInverse, OfASquareMatrixIsItsInverse) {  // (143)
  const Mat3 a = (Mat3() << 2, 1, 0, -1, 3, 1, 0.5, 0, 4).finished();
  EXPECT_LT((pseudoInverse(a) - a.inverse()).norm(), 1e-15);
}

TEST(PseudoInverse, DoesNotMindARowThatSaysTheSameTwice) {
  Eigen::MatrixXd j(2, 3);
  j << 1, 2, 2, 1, 2, 2;
  const Eigen::Vector2d c(9, 9);
  const Eigen::VectorXd step = leastStep(j, c);
  EXPECT_LT((step + Vec3(1, 2, 2)).norm(), 1e-14);
}

TEST(PseudoInverse, StepSolvesTheConstraintAndIsStationary) {  // (145)-(148)
  Eigen::MatrixXd j(2, 4);
  j << 1, 2, 0, -1, 0.5, -1, 3, 2;
  const Eigen::Vector2d c(0.3, -0.7);
  const Eigen::VectorXd step = leastStep(j, c), lambda = leastMultipliers(j, c);
  EXPECT_LT((c + j * step).norm(), 1e-15);
  EXPECT_LT((step - j.transpose() * lambda).norm(), 1e-15);
}

}  // namespace
}  // namespace physics::testing
