// The direct method.
#include "physics/sweep/direct.h"

#include <Eigen/LU>
#include <algorithm>

#include "physics/base/profile.h"
#include "physics/constraints/pull_stiffness.h"
#include "physics/motion/second_order.h"
#include "physics/sweep/active_set.h"
#include "physics/sweep/direct_apply.h"
#include "physics/sweep/nonlinear_gauss_seidel.h"

namespace physics {
namespace {

// Keeps the factor regular where rows repeat each other (loops): relative to the joint's own A.
// NOTES 3.5
constexpr double kRedundancy = 1e-12;

// Second-order steppings: Newton goes on until no joint is further open, in the unit of its rows.
constexpr double kClosed = 1e-9;
constexpr int kMostSteps = 40;

Scheme schemeOf(const Bodies& bodies, BodyId i) {
  return bodies.second.empty() ? Scheme::kPaper : bodies.second.scheme[i];
}

// c at the present poses; J there, or at the start of the step where the symmetric scheme
// displaces.
template <class C>
JointRows rowsOf(const C& item, const Bodies& bodies, double dt, Stage stage,
                 Row<C::kBodies, C::kRows>& row) {
  Configuration at = configurationOf(item, bodies, dt);
  item.evaluate(at, row);
  JointRows joint;
  joint.bodies = item.bodies;
  joint.rows = C::kRows;
  joint.isSymmetric = isSymmetric(item, bodies);
  joint.right.head(C::kRows) = -row.c;
  joint.error = row.c.norm();
  if (joint.isSymmetric && stage == Stage::kDisplacements) {
    at.now = bodies.start;
    item.evaluate(at, row);
  }
  for (int b = 0; b < 2; ++b) {
    joint.linear[b].setZero();
    joint.angular[b].setZero();
    if constexpr (C::kLinear) joint.linear[b].template topRows<C::kRows>() = row.linear[b];
    if constexpr (isAngular<C>()) joint.angular[b].template topRows<C::kRows>() = row.angular[b];
  }
  return joint;
}

// Adds J^T lambda, and K of a force that acts at a point of the body: along the arm it stiffens the
// turn.
template <class C>
void load(const C& item, const JointRows& joint, const Bodies& bodies,
          std::span<JointMotion> motion) {
  const Vec3 lambda = joint.totals();
  for (int b = 0; b < 2; ++b) {
    JointMotion& body = motion[item.bodies[b]];
    const Vec3 force = joint.linear[b].transpose() * lambda;
    body.impulse += force;
    body.torque += joint.angular[b].transpose() * lambda;
    if (joint.isSymmetric) continue;  // its directions do not turn with the displacement
    if constexpr (requires { item.anchors; }) {
      const Vec3 arm = bodies.pose[item.bodies[b]].q * item.anchors[b];
      body.stiffnessAngular += pullStiffness(force, arm);
    }
    if constexpr (requires { item.length; }) {  // a link under tension also resists going sideways
      const Vec3 d = joint.linear[b].row(0).transpose();
      if (lambda[0] < 0 && item.length > 0) {
        body.stiffnessLinear -= lambda[0] / item.length * (Mat3::Identity() - d * d.transpose());
      }
    }
  }
}

// What the balance of angular momentum still lacks, in the units of lambda: (M dX - J^T lambda).
Vec3 twistLeft(const Bodies& bodies, BodyId i, const Mat3& inertia, const JointMotion& m) {
  const Scheme scheme = schemeOf(bodies, i);
  if (scheme == Scheme::kBdf2) return -missingTwist(bodies, i) - m.torque;
  if (scheme == Scheme::kSymmetric) return bodies.second.jointTwist[i] - m.torque;
  return inertia * m.dtheta - m.torque;
}

void invertMasses(SweepModel& world) {
  for (const BodyId i : world.bodies.active) {
    JointMotion& m = world.jointMotion[i];
    const InverseMass& inverse = world.bodies.inverse[i];
    m.inverseLinear = inverse.m * Mat3::Identity();
    m.inverseAngular = inverse.inertia;
    if (inverse.m == 0) continue;
    const double mass = world.bodies.mass[i];
    if (!m.stiffnessLinear.isZero(0)) {
      m.inverseLinear = (mass * Mat3::Identity() + m.stiffnessLinear).inverse();
    }
    m.lagLinear = m.inverseLinear * (mass * m.dx - m.impulse);
    if (world.bodies.inverseInertia[i].isZero(0)) continue;
    const Mat3 rotation = world.bodies.pose[i].q.toRotationMatrix();
    const Mat3 inertia = rotation * world.bodies.inertia[i].asDiagonal() * rotation.transpose();
    m.inverseAngular = (inertia + m.stiffnessAngular).inverse();
    m.lagAngular = m.inverseAngular * twistLeft(world.bodies, i, inertia, m);
  }
}

void respond(const SweepModel& world, JointRows& joint) {
  double trace = 0;
  for (int b = 0; b < 2; ++b) {
    const JointMotion& m = world.jointMotion[joint.bodies[b]];
    joint.responseLinear[b] = m.inverseLinear * joint.linear[b].transpose();
    joint.responseAngular[b] = m.inverseAngular * joint.angular[b].transpose();
    trace += joint.linear[b].cwiseProduct(joint.responseLinear[b].transpose()).sum() +
             joint.angular[b].cwiseProduct(joint.responseAngular[b].transpose()).sum();
    joint.right += joint.linear[b] * m.lagLinear + joint.angular[b] * m.lagAngular;
  }
  const double mean = trace / joint.rows;
  joint.alpha =
      mean > 0 ? std::max(joint.regularisation, kRedundancy) * mean : 1;  // 1: nothing can move
  if (joint.regularisation > 0) joint.right -= joint.alpha * joint.totals();
}

// The joints of a kind that the direct method takes as rows.
template <class K>
void gatherKind(K& kind, SweepModel& world, double dt, Stage stage) {
  using C = typename K::Item;
  if constexpr (!Force<C> && C::kBodies == 2) {
    auto& set = kind.set;
    for (const int k : set.active) {
      const C& item = set.items[k];
      if (!isSolvedDirectly(item)) continue;
      Row<C::kBodies, C::kRows> row;
      JointRows joint = rowsOf(item, world.bodies, dt, stage, row);
      joint.word = K::kWord;
      joint.item = static_cast<std::size_t>(k);
      joint.total = set.lambda[k].total.data();
      joint.regularisation = set.tuned[k].regularisation;
      if (!world.jointRows.empty()) joint.first = world.jointRows.back().end();
      chooseActive(item, row, stage, world.bodies, set.lambda[k].total, joint);
      load(item, joint, world.bodies, world.jointMotion);
      world.jointRows.push_back(joint);
    }
  }
}

// All joints at the present poses, and what their present multipliers do.
void gather(SweepModel& world, double dt, Stage stage) {
  for (JointMotion& m : world.jointMotion) {
    const Vec3 dx = m.dx, dtheta = m.dtheta;
    m = JointMotion{};
    m.dx = dx;
    m.dtheta = dtheta;
  }
  world.jointRows.clear();
  forEachKind(world.kinds, [&](auto& kind) { gatherKind(kind, world, dt, stage); });
  invertMasses(world);
  for (JointRows& joint : world.jointRows) respond(world, joint);
}

// The joints' part of the angular impulse of bodies that step symmetrically, and where it turns
// them.
void turnSymmetric(SweepModel& world) {
  SecondOrder& second = world.bodies.second;
  if (second.empty()) return;
  for (Vec3& twist : second.jointTwist) twist.setZero();
  for (const JointRows& joint : world.jointRows) {
    if (!joint.isSymmetric) continue;
    for (int b = 0; b < 2; ++b) {
      second.jointTwist[joint.bodies[b]] += joint.angular[b].transpose() * joint.totals();
    }
  }
  balance(world.bodies, Scheme::kSymmetric);
}

double largestError(const SweepModel& world) {
  double largest = 0;
  for (const JointRows& joint : world.jointRows) largest = std::max(largest, joint.error);
  for (const JointMotion& m : world.jointMotion) {
    largest = std::max({largest, m.lagLinear.norm(), m.lagAngular.norm()});
  }
  return largest;
}

// Joints that let go, or pull where they may only push: the active set is not found yet.
bool setChanges(const SweepModel& world) {
  return std::any_of(world.jointRows.begin(), world.jointRows.end(), [](const JointRows& joint) {
    return joint.changes || joint.side * joint.total[0] < 0;
  });
}

// One Newton step for all joints. False: the factor broke down or gave something not finite.
bool newtonStep(SweepModel& world, double dt) {
  gather(world, dt, Stage::kDisplacements);
  if (world.jointRows.empty()) {
    balance(world.bodies);
    return true;
  }
  if (!world.joints.isLaidOutFor(world.jointRows.size())) {
    world.joints.layOut(world.jointRows, world.bodies);
  }
  world.jointChange.assign(world.jointRows.size(), Vec3::Zero());
  if (!world.joints.factorize(world.jointRows)) return false;
  world.joints.solve(world.jointRows, world.jointChange);
  double sum = 0;
  for (const Vec3& change : world.jointChange) sum += change.sum();
  if (!std::isfinite(sum)) return false;
  world.jointError = world.bodies.second.empty() ? 0 : largestError(world);
  applyNewtonStep(world);
  turnSymmetric(world);
  if (setChanges(world)) world.jointError = std::numeric_limits<double>::infinity();
  return true;
}

}  // namespace

void prepareDirect(SweepModel& world) {
  world.jointMotion.assign(world.bodies.pose.size(), JointMotion{});
  world.jointError = 0;
}

void projectJoints(SweepModel& world) {
  gather(world, 0, Stage::kVelocities);
  if (world.jointRows.empty()) return;
  for (JointRows& joint : world.jointRows) {
    joint.right.setZero();
    for (int b = 0; b < 2; ++b) {
      const Velocity& velocity = world.bodies.velocity[joint.bodies[b]];
      joint.right -= joint.linear[b] * velocity.v + joint.angular[b] * velocity.w;
    }
  }
  if (!world.joints.factorize(world.jointRows)) return;
  world.joints.solve(world.jointRows, world.jointChange);
  for (std::size_t k = 0; k < world.jointRows.size(); ++k) {
    const JointRows& joint = world.jointRows[k];
    if (!joint.isSymmetric) continue;
    for (int b = 0; b < 2; ++b) {
      Velocity& velocity = world.bodies.velocity[joint.bodies[b]];
      velocity.v += joint.responseLinear[b] * world.jointChange[k];
      velocity.w += joint.responseAngular[b] * world.jointChange[k];
    }
  }
}

void nameWorstJoint(const SweepModel& world, StepReport& report) {
  const JointRows* worst = nullptr;
  double most = -1;
  for (std::size_t k = 0; k < world.jointRows.size(); ++k) {
    const double size = world.jointRows[k].right.norm() + world.jointChange[k].norm();
    if (!std::isfinite(most) || size <= most) continue;
    most = size;
    worst = &world.jointRows[k];
  }
  if (worst != nullptr)
    nameCulprit(report, worst->word, worst->item, moverOf(*worst, world.bodies));
}

void direct(SweepModel& world, double dt, StepReport& report) {
  const int least = world.settings.iterations;
  for (int k = 0; k < least || (k < kMostSteps && world.jointError > kClosed); ++k) {
    if (k > 0) refreshIterate(world, dt);
    profileScope("direct");
    report.constraintEvaluations += static_cast<std::int64_t>(world.jointRows.size());
    if (!newtonStep(world, dt)) return nameWorstJoint(world, report);
    if (!sweep(world, dt, report)) return;
  }
}

}  // namespace physics
