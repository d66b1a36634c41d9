// The symmetric step.
#include "physics/accurate/symmetric_step.h"

#include <algorithm>

#include "physics/base/rotation.h"
#include "physics/constraints/constraint_symmetric.h"

namespace physics {

// Only rows of other kinds than gaps are evaluated there.
void SymmetricStep::put(const IslandState& state, std::span<Pose> to) const {
  for (std::size_t i = 0; isSeenAway_ && i < bodies_.size(); ++i) to[bodies_[i]] = state.pose[i];
}

// M^-1 where the island is.
void SymmetricStep::turnInertia() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    BodyInverse& body = present_.inverse[i];
    body.turns = turns(i);
    if (!body.turns) continue;
    const Vec3& principal = inverseInertia_[i];
    if (isIsotropic(inertia_[i])) {
      body.inertia = principal.x() * Mat3::Identity();
      continue;
    }
    const Mat3 r = present_.state.pose[i].q.toRotationMatrix(), scaled = r * principal.asDiagonal();
    body.inertia = scaled * r.transpose();
  }
}

// c and J of the joints, where `now` has the poses of `at`.
void SymmetricStep::lookAt(const IslandState& at, std::span<const Pose> now,
                           const TrialPoses& trial, const Surroundings& world, double h) {
  JointRow row;
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    if (isForce_[i]) continue;
    if (ahead_[i].form == IslandRow::Form::kGap) {  // (71), (72)
      const JointShape& shape = topology_->shapes[i];
      const Pose &a = at.pose[shape.body[0]], &b = at.pose[shape.body[1]];
      ahead_[i].arm[0] = a.q * anchors_[i][0];
      ahead_[i].arm[1] = b.q * anchors_[i][1];
      error_[i] = (a.x + ahead_[i].arm[0]) - (b.x + ahead_[i].arm[1]);
      continue;
    }
    clear(row);
    evaluateRow(world.kinds, refs_[i], {now, trial.start, h}, row);
    error_[i] = row.c;
    takeRow(row, ahead_[i]);
  }
}

// Of forces, halfway: K^-1 (lambda / 2 - f), and J. What does not fall off is given.
void SymmetricStep::lookAtForces(const Surroundings& world, const TrialPoses& trial, double h) {
  if (!hasForces_) return;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    trial.now[bodies_[i]] = middleOf(present_.state.pose[i], to_.pose[i]);
  }
  JointRow row;
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    if (!isForce_[i]) continue;
    clear(row);
    evaluateRow(world.kinds, refs_[i], {trial.now, trial.start, 0.5 * h, {}, {}, trial.end}, row);
    IslandRow& to = present_.rows[i];
    takeRow(row, to);
    to.solved = row.active && row.role == JointRow::Role::kForce;
    error_[i].setZero();
    if (to.solved) {
      to.alpha = row.alpha;
      error_[i] = row.alpha * lambda_[i] + 2 * row.c;
    } else {
      lambda_[i] = row.active ? (2 * row.c).eval() : Vec3::Zero();
    }
  }
}

// What joints pulled with goes on changing as it did.
void SymmetricStep::guess(double h) {
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    const Pull& pull = present_.pulls[i];
    const double further = present_.h > 0 ? 1 + h / present_.h : 0;
    lambda_[i] = h * h * (pull.next + further * pull.change);
  }
}

// What lambda gives to bodies.
void SymmetricStep::sum() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    shift_[i].setZero();
    twist_[i].setZero();
  }
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    const JointShape& shape = topology_->shapes[i];
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      addPull(present_.rows[i], b, lambda_[i], shift_[shape.body[b]], twist_[shape.body[b]]);
    }
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) shift_[i] *= present_.inverse[i].mass;
}

Vec3 SymmetricStep::momentumOf(std::size_t i) const {
  const Quat& q = present_.state.pose[i].q;
  return q * inertia_[i].cwiseProduct(q.conjugate() * present_.state.velocity[i].w);
}

// What gravity and loads accelerate it by [m/s^2].
Vec3 SymmetricStep::pullOn(std::size_t i, const Surroundings& world) const {
  return world.gravity + present_.inverse[i].mass * world.loads[bodies_[i]].force;
}

// What a step's tries have in common.
void SymmetricStep::begin(double h, const Surroundings& world) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!turns(i)) continue;
    Spin& spin = spins_[i];
    spin.pushed = momentumOf(i) + 0.5 * h * world.loads[bodies_[i]].torque;
    spin.turned = present_.state.pose[i].q.toRotationMatrix();
    spin.start = spin.omega = spin.mean = spin.turned.transpose() * present_.state.velocity[i].w;
  }
}

// To the end of the step, by lambda. False: joints turn a body by half a turn and more, which no
// step of that length follows.
bool SymmetricStep::move(double h, const Surroundings& world) {
  const IslandState& from = present_.state;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!moves_[i]) continue;
    to_.pose[i].x =
        from.pose[i].x + h * (from.velocity[i].v + 0.5 * h * pullOn(i, world)) + shift_[i];
    if (!turns(i)) continue;
    Spin& spin = spins_[i];
    momentum_[i] = spin.pushed + twist_[i] / h;
    const Vec3 omega = inverseInertia_[i].cwiseProduct(spin.turned.transpose() * momentum_[i]);
    if (!(h * (omega - spin.start).norm() < kPi)) return false;
    const Vec3 guess = spin.mean + (omega - spin.omega);
    spin.omega = omega;
    spin.mean = isIsotropic(inertia_[i]) ? omega : freeTurn(inertia_[i], omega, h, 0.5, guess).mean;
    const Quat& q = from.pose[i].q;
    to_.pose[i].q = exponential(h * (spin.turned * spin.mean)) * q;
    renormalize(to_.pose[i].q);
  }
  return true;
}

// Velocities at the end: what is halfway, and the other half.
void SymmetricStep::finish(double h, const Surroundings& world) {
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    present_.pulls[i].next = lambda_[i] / (h * h);
  }
  IslandState& state = present_.state;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!moves_[i]) continue;
    state.velocity[i].v = (to_.pose[i].x - state.pose[i].x) / h + 0.5 * h * pullOn(i, world);
    if (turns(i)) momentum_[i] += 0.5 * h * world.loads[bodies_[i]].torque;
  }
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    if (!isForce_[i]) continue;
    const JointShape& shape = topology_->shapes[i];
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      const int body = shape.body[b];
      const IslandRow& row = present_.rows[i];
      state.velocity[body].v +=
          present_.inverse[body].mass / h * (row.linear[b].transpose() * lambda_[i]);
      momentum_[body] += row.angular[b].transpose() * lambda_[i] / h;
    }
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!moves_[i]) continue;
    state.pose[i] = to_.pose[i];
    if (!turns(i)) continue;
    const Quat& q = state.pose[i].q;
    state.velocity[i].w = q * inverseInertia_[i].cwiseProduct(q.conjugate() * momentum_[i]);
  }
}

// Rows where the island was last looked at, and their factor.
void SymmetricStep::takeRows() {
  std::swap(present_.rows, ahead_);
  for (std::size_t i = 0; hasForces_ && i < refs_.size(); ++i) {
    if (isForce_[i]) present_.rows[i].solved = false;
  }
  present_.joints.factorize(present_.rows, present_.inverse);
}

// Takes the velocities that open joints, by rows and inertia where the island now is.
void SymmetricStep::stop(double h) {
  if (refs_.empty()) return;
  takeRows();
  std::vector<Velocity>& velocity = present_.state.velocity;
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    error_[i].setZero();
    if (isForce_[i]) continue;
    const JointShape& shape = topology_->shapes[i];
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      const Velocity& v = velocity[shape.body[b]];
      error_[i] -= opening(present_.rows[i], b, v.v, v.w);
    }
  }
  present_.joints.solve(error_);
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    if (isForce_[i]) continue;
    const JointShape& shape = topology_->shapes[i];
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      const BodyInverse& inverse = present_.inverse[shape.body[b]];
      Velocity& v = velocity[shape.body[b]];
      Vec3 along = Vec3::Zero(), about = Vec3::Zero();
      addPull(present_.rows[i], b, error_[i], along, about);
      v.v += inverse.mass * along;
      v.w += inverse.inertia * about;
    }
    if (h > 0) {
      // lambda is the force a third of a step after its start, mu that a third before its end.
      Pull& pull = present_.pulls[i];
      const Vec3 end = error_[i] / h;
      pull.change = end - pull.next;
      pull.next = end;
    }
  }
  if (h > 0) present_.h = h;
}

// Of the largest way of a body, what stops at once leaves a half, what a step resolves much less:
// from a tenth to two fifths make no difference to rows of parallelograms.
double SymmetricStep::jumpFrom(const IslandState& before, double h) const {
  constexpr double kSmooth = 0.25;
  double most = 0, way = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!moves_[i]) continue;
    const Velocity &start = before.velocity[i], &end = present_.state.velocity[i];
    const Vec3 v = 0.5 * (start.v + end.v), w = 0.5 * (start.w + end.w);
    double off = (present_.state.pose[i].x - before.pose[i].x - h * v).norm();
    if (turns(i)) off += h * levers_[i] * (spins_[i].turned * spins_[i].mean - w).norm();
    most = std::max(most, off);
    way = std::max(way, 0.5 * h * (speedOf(i, start) + speedOf(i, end)));
  }
  return most > kSmooth * way ? most : 0;
}

bool SymmetricStep::isLimited(const Kinds& kinds) const {
  return std::any_of(limits_.begin(), limits_.end(),
                     [&](const JointRef ref) { return carries(kinds, ref); });
}

bool SymmetricStep::meetsLimit(const Surroundings& world, const TrialPoses& trial) const {
  JointRow row;
  for (const JointRef ref : limits_) {
    clear(row);
    evaluateRow(world.kinds, ref, {trial.end, trial.start, 1}, row);
    if (row.active && ((row.high == 0 && row.c[0] > 0) || (row.low == 0 && row.c[0] < 0))) {
      return true;
    }
  }
  return false;
}

bool SymmetricStep::step(double h, double tolerance, const Surroundings& world,
                         const TrialPoses& trial) {
  hasStepped_ = true;
  put(present_.state, trial.start);
  begin(h, world);
  guess(h);
  if (!close(h, tolerance, world, trial)) {
    if (!isLoop()) return false;
    guess(h);
    if (!closeAcross(h, tolerance, world, trial)) return false;
  }
  if (meetsLimit(world, trial)) return false;
  if (isLoop()) before_ = present_.state;
  finish(h, world);
  turnInertia();
  stop(h);
  if (isLoop()) jump_ = std::max(jump_, jumpFrom(before_, h));
  return true;
}

}  // namespace physics
