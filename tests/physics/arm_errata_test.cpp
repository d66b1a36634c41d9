// Misprints of the paper's section 11: the printed form beside ours. And (150): what the diagonal
// of the mass matrix costs.
#include <gtest/gtest.h>

#include "tests/physics/arms.h"

namespace physics::testing {
namespace {

const Vec3 kTarget(0.8, 0.45, 0);

TEST(Erratum149, TheErrorCountsFromTheRoot) {
  ArmDef def = planarArm();
  def.at = Vec3(1, 2, 3);
  Arm arm = makeArm(def);
  const Vec3 target = def.at + kTarget;
  reach(arm, target, def.solve, 60, 1e-9);
  const ArmPosture posture = postureOf(arm);
  EXPECT_LT(tipError(posture, target).c, 1e-9);
  const double printed = (posture.tip - arm.root - target).norm();  // |sum r_i - x_T|
  EXPECT_NEAR(printed, def.at.norm(), 1e-8);
}

TEST(Erratum153, TheSumOfSkewMatricesIsTheNegativeOfTheInverseMass) {
  Random random(6);
  const Arm arm = makeArm(randomArm(random, 6));
  const ArmPosture posture = postureOf(arm);
  const std::vector<Mat3> p = mobilities(arm, posture);
  const Vec3 n = randomVector(random).normalized();
  double byRows = 0;  // J M^-1 J^T, row times column
  Mat3 printed = Mat3::Zero();
  for (int k = 0; k < arm.size(); ++k) {
    const Vec3 row = posture.toTip(k).cross(n);
    byRows += row.transpose() * p[k] * row;
    printed += skew(posture.toTip(k)) * p[k] * skew(posture.toTip(k));
  }
  EXPECT_GT(byRows, 0);
  EXPECT_NEAR(inverseMass(posture, p, n), byRows, 1e-14 * byRows);
  EXPECT_NEAR(n.dot(printed * n), -byRows, 1e-13 * byRows);
}

// Iterations of lambda - mu (c + weight alpha lambda), mu = 1 / (A + alpha), and the distance left.
double distanceLeft(double weight, double alpha) {
  Arm arm = makeArm(planarArm());
  double lambda = 0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const ArmPosture posture = postureOf(arm);
    const TipError error = tipError(posture, kTarget);
    const std::vector<Mat3> p = mobilities(arm, posture);
    const double mu = 1 / (inverseMass(posture, p, error.n) + alpha);
    const double change = -mu * (error.c + weight * alpha * lambda);
    lambda += change;
    for (int k = 0; k < arm.size(); ++k) {
      turnJoint(arm, posture, k, p[k] * gradientOf(posture, k, error.n) * change, arm.joints[k]);
    }
  }
  return errorOf(arm, kTarget);
}

TEST(Erratum154, AlphaLambdaInTheUpdateMissesTheTargetWithEitherSign) {
  const double weak = 1e-3, strong = 1e-2;
  for (const double printed : {-1.0, 1.0}) {  // + is (56): compliance, out of place in a target
    EXPECT_GT(distanceLeft(printed, weak), 1e-5);
    EXPECT_GT(distanceLeft(printed, strong), 5 * distanceLeft(printed, weak));
  }
  EXPECT_LT(distanceLeft(0, weak), 1e-12);  // alpha in mu only
  EXPECT_LT(distanceLeft(0, strong), 1e-12);
}

TEST(Erratum154, IsWhatIterateDoesWithAlphaInMuOnly) {
  ArmDef def = planarArm();
  def.solve.regularisation = 0.01;
  Arm arm = makeArm(def);
  const ArmPosture posture = postureOf(arm);
  const std::vector<Mat3> p = mobilities(arm, posture);
  const TipError error = tipError(posture, kTarget);
  ArmScratch scratch;
  const ArmIteration done = iterate(arm, kTarget, def.solve, scratch);
  const double alpha = 0.01 * meanInverseMass(posture, p);
  EXPECT_NEAR(done.lambda, -error.c / (inverseMass(posture, p, error.n) + alpha), 1e-15);
}

// ½ Δθ^T M Δθ of the step that takes the tip of a straight arm `move` aside, of M's diagonal,
// of M itself or of M = 1.
struct Efforts {
  double exact, diagonal, one;
};
Efforts effortsOfAMoveAside(double move) {
  const Arm arm = makeArm(planarArm(0));
  const ArmPosture posture = postureOf(arm);
  Eigen::VectorXd j(6);
  Eigen::MatrixXd mass(6, 6);
  for (int k = 0; k < 6; ++k) {
    j[k] = gradientOf(posture, k, -Vec3::UnitY()).z();
    for (int l = 0; l < 6; ++l) {  // by the polarisation of the effort
      std::vector<Vec3> turns(6, Vec3::Zero());
      const auto effort = [&](double a, double b) {
        turns.assign(6, Vec3::Zero());
        turns[k].z() += a, turns[l].z() += b;
        return effortOf(arm, posture, turns);
      };
      mass(k, l) = effort(1, 1) - effort(1, 0) - effort(0, 1);
    }
  }
  const auto effort = [&](const Eigen::MatrixXd& inverse) {
    const Eigen::VectorXd step = -inverse * j * move / j.dot(inverse * j);
    return 0.5 * step.dot(mass * step);
  };
  const Eigen::VectorXd diagonal = mass.diagonal().cwiseInverse();
  return {effort(mass.inverse()), effort(diagonal.asDiagonal()),
          effort(Eigen::MatrixXd::Identity(6, 6))};
}

TEST(Equation150, TheDiagonalIsBetweenTheWholeMassMatrixAndNone) {
  const Efforts efforts = effortsOfAMoveAside(0.02);
  EXPECT_NEAR(efforts.exact, 5.7735042735e-5, 1e-14);  // all three in rational numbers, by hand
  EXPECT_NEAR(efforts.diagonal, 1.2578092461e-4, 1e-14);
  EXPECT_NEAR(efforts.one, 3.0507587650e-4, 1e-14);
}

}  // namespace
}  // namespace physics::testing
