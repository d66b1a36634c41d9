// The iteration on an arm's joints.
#include "physics/kinematics/arm_solve.h"

#include <algorithm>

#include "physics/base/rotation.h"
#include "physics/kinematics/arm_joint.h"

namespace physics {
namespace {

constexpr double kBend = 0.02;         // rad
constexpr double kNoGradient = 1e-12;  // J M^-1 J^T against its mean over directions
constexpr int kMostTrials = 20;        // each with four times the alpha of the one before
constexpr double kGrowth = 4;
constexpr double kPromise = 0.5;  // of the promised decrease, to be content with

void setMobility(const Arm& arm, ArmForm form, ArmScratch& s) {
  s.mobility.resize(arm.links.size());
  if (form == ArmForm::kMassWeighted) pivotInertias(arm, s.now, s.inertia);
  for (int k = 0; k < arm.size(); ++k) {
    const bool weighted = form == ArmForm::kMassWeighted;
    s.mobility[k] = mobility(arm, s.now, k, weighted ? s.inertia[k] : Mat3::Identity());
  }
}

// The active set: what stands at its limit and would go further is left out of J.
int holdLimits(const Arm& arm, const Vec3& n, ArmScratch& s) {
  int held = 0;
  for (int k = 0; k < arm.size(); ++k) {
    const Vec3 turn = -s.mobility[k] * gradientOf(s.now, k, n);
    held += holdAtLimit(arm, s.now, k, turn, s.mobility[k]);
  }
  return held;
}

// turns_k = P_k (s_k x n) dlambda, shortened where one is longer than `most`. Returns by how much.
double setTurns(const Vec3& n, double dlambda, double most, ArmScratch& s) {
  double longest = 0;
  s.turns.resize(s.mobility.size());
  for (std::size_t k = 0; k < s.turns.size(); ++k) {
    s.turns[k] = s.mobility[k] * gradientOf(s.now, static_cast<int>(k), n) * dlambda;
    longest = std::max(longest, s.turns[k].norm());
  }
  const double part = longest > most ? most / longest : 1;
  for (Vec3& turn : s.turns) turn *= part;
  return part;
}

// Turns the joints of scratch.before by scratch.turns into arm.joints, and back to their limits.
// Returns whether some were beyond.
bool turnAll(Arm& arm, ArmScratch& s) {
  bool clamped = false;
  for (int k = 0; k < arm.size(); ++k) {
    arm.joints[k] = s.before[k];
    turnJoint(arm, s.now, k, s.turns[k], arm.joints[k]);
    clamped |= clampToLimit(arm, k, arm.joints[k]);
  }
  place(arm, arm.joints, s.tried);
  return clamped;
}

// The turns that were made, limits and all, in the world frame.
void measureTurns(const Arm& arm, ArmScratch& s) {
  for (int k = 0; k < arm.size(); ++k) {
    s.turns[k] = parentOf(arm, s.now, k) * turnBetween(arm.links[k], s.before[k], arm.joints[k]);
  }
}

// (154). False: no step brings the tip nearer.
bool step(Arm& arm, const Vec3& target, const TipError& error, const ArmSolve& solve, double a,
          double mean, ArmScratch& s, double& lambda) {
  double alpha = solve.regularisation * mean;
  for (int trial = 0; trial < kMostTrials; ++trial) {
    const double mu = 1 / (a + alpha);                        // (153)
    const double dlambda = -solve.relaxation * mu * error.c;  // (154), alpha in mu only
    const double part = setTurns(error.n, dlambda, solve.maxTurn, s);
    const bool clamped = turnAll(arm, s);
    lambda = part * dlambda;
    if (solve.regularisation == 0) return true;
    const double gained = error.c - tipError(s.tried, target).c;
    const double promised = error.c - std::abs(error.c + lambda * a);
    if (gained > (clamped ? 0 : kPromise * promised)) return true;
    alpha = std::max(kGrowth * alpha, 0.1 * a);
  }
  arm.joints = s.before;
  return false;
}

}  // namespace

TipError tipError(const ArmPosture& posture, const Vec3& target) {
  const Vec3 apart = posture.tip - target;
  const double c = apart.norm();
  if (!(c > 0)) return {};
  return {c, apart / c};
}

double inverseMass(const ArmPosture& posture, std::span<const Mat3> mobility, const Vec3& n) {
  double sum = 0;
  for (std::size_t k = 0; k < mobility.size(); ++k) {
    const Vec3 j = gradientOf(posture, static_cast<int>(k), n);
    sum += j.dot(mobility[k] * j);
  }
  return sum;
}

double meanInverseMass(const ArmPosture& posture, std::span<const Mat3> mobility) {
  double sum = 0;
  for (std::size_t k = 0; k < mobility.size(); ++k) {
    const Vec3 s = posture.toTip(static_cast<int>(k));
    sum += mobility[k].trace() * s.squaredNorm() - s.dot(mobility[k] * s);
  }
  return sum / 3;
}

bool bendAside(Arm& arm, const Vec3& target, const TipError& error, ArmScratch& s) {
  const Vec3 aside = anyNormalTo(error.n);
  const auto axis = [&](int k) {
    return arm.links[k].hinge ? Vec3(parentOf(arm, s.now, k) * arm.links[k].axis) : aside;
  };
  const auto nearer = [&](int i, double turnI, int j, double turnJ) {
    std::fill(s.turns.begin(), s.turns.end(), Vec3::Zero());
    if (j < arm.size()) s.turns[j] = turnJ * axis(j);
    s.turns[i] += turnI * axis(i);
    turnAll(arm, s);
    return tipError(s.tried, target).c < error.c * (1 - 1e-9);
  };
  s.before = arm.joints;
  s.turns.assign(arm.links.size(), Vec3::Zero());
  for (int apart = 0; apart <= 2; ++apart) {  // alone, with the next joint, with the one after
    for (int i = arm.size() - 1 - apart; i >= 0; --i) {
      const int j = i + apart;
      const double whole = s.now.toTip(i).norm(), rest = s.now.toTip(j).norm();
      const double back = apart == 0 || rest < 1e-12 * whole ? 0 : whole / rest;
      for (const double bend : {kBend, -kBend}) {
        const double turnI = back > 1 ? bend / back : bend;
        if (nearer(i, turnI, j, apart == 0 ? 0 : -turnI * back)) return true;
      }
    }
  }
  arm.joints = s.before;
  return false;
}

ArmIteration iterate(Arm& arm, const Vec3& target, const ArmSolve& solve, ArmScratch& s) {
  ArmIteration out;
  place(arm, arm.joints, s.now);
  const TipError error = tipError(s.now, target);
  out.error = error.c;
  if (error.c == 0) return out;
  s.before = arm.joints;
  setMobility(arm, solve.form, s);
  const double mean = meanInverseMass(s.now, s.mobility);
  out.held = holdLimits(arm, error.n, s);
  const double a = inverseMass(s.now, s.mobility, error.n);
  if (a > kNoGradient * mean) {
    out.moved = step(arm, target, error, solve, a, mean, s, out.lambda);
  } else {
    out.moved = out.bent = bendAside(arm, target, error, s);
  }
  if (!out.moved) return out;
  measureTurns(arm, s);
  out.effort = effortOf(arm, s.now, s.turns);
  return out;
}

}  // namespace physics
