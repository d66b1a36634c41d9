// A symmetric step's island: what it is made of, and how it is put into a state.
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/accurate/symmetric_step.h"
#include "physics/base/archive.h"
#include "physics/base/rotation.h"
#include "physics/bodies/shape.h"

namespace physics {
namespace {

std::vector<BodyId> bodiesOf(std::span<const JointRef> refs, std::span<const BodyId> moving,
                             const Kinds& kinds) {
  std::vector<BodyId> all(moving.begin(), moving.end());
  for (const JointRef ref : refs) {
    const JointKind kind = kindOf(kinds, ref);
    all.insert(all.end(), kind.bodies.begin(), kind.bodies.begin() + kind.bodyCount);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

// Of a body by itself: its shape's, and no less than its mass reaches.
double SymmetricStep::leverOf(std::size_t place, const Surroundings& world) const {
  if (!turns(place)) return 0;
  const BodyId i = bodies_[place];
  const double gyration = std::sqrt(inertia_[place].maxCoeff() / world.bodies.mass[i]);
  return std::max(boundingRadius(world.bodies.shape[i]), gyration);
}

bool SymmetricStep::takes(std::span<const JointRef> refs, const Surroundings& world) {
  return std::all_of(refs.begin(), refs.end(), [&](const JointRef ref) {
    const JointKind kind = kindOf(world.kinds, ref);
    if (kind.rows == 0 || kind.regularisation > 0 || natureOf(world.kinds, ref) == Nature::kOther) {
      return false;
    }
    for (int b = 0; b < kind.bodyCount; ++b) {
      if (world.bodies.motion[kind.bodies[b]] == Motion::kKinematic) return false;
    }
    return true;
  });
}

SymmetricStep::SymmetricStep(std::span<const JointRef> refs, std::span<const BodyId> moving,
                             const Surroundings& world, JointTopologies& known)
    : bodies_(bodiesOf(refs, moving, world.kinds)) {
  std::vector<JointRef> solved;
  for (const JointRef ref : refs) {
    (natureOf(world.kinds, ref) == Nature::kOneSided ? limits_ : solved).push_back(ref);
  }
  std::vector<JointKind> kinds;
  for (const JointRef ref : solved) kinds.push_back(kindOf(world.kinds, ref));
  topology_ = topologyOf(solved, kinds, bodies_, world.bodies.inverse, known);
  for (const int i : topology_->order) {
    refs_.push_back(solved[i]);
    isForce_.push_back(natureOf(world.kinds, solved[i]) == Nature::kForce);
    hasForces_ = hasForces_ || isForce_.back();
  }
  for (const BodyId i : bodies_) {
    moves_.push_back(world.bodies.motion[i] == Motion::kDynamic);
    inertia_.push_back(world.bodies.inertia[i]);
    inverseInertia_.push_back(world.bodies.inverseInertia[i]);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) levers_.push_back(leverOf(i, world));
  const std::size_t rows = refs_.size(), size = bodies_.size();
  isDamped_.assign(rows, false);
  present_.joints = RowSystem(topology_);
  all_ = RowSystem(topology_);
  if (!topology_->isTree) across_ = CrossSystem(topology_);
  present_.rows.resize(rows);
  present_.pulls.resize(rows);
  present_.inverse.resize(size);
  spins_.resize(size);
  ahead_.resize(rows);
  for (std::size_t i = 0; i < rows; ++i) present_.rows[i].solved = ahead_[i].solved = !isForce_[i];
  for (auto* list : {&error_, &lambda_}) list->assign(rows, Vec3::Zero());
  for (auto* list : {&shift_, &twist_, &momentum_}) list->assign(size, Vec3::Zero());
}

void SymmetricStep::put(const IslandState& state, const Surroundings& world,
                        const TrialPoses& trial) {
  present_.state = to_ = state;
  for (const std::span<Pose> poses : {trial.now, trial.start, trial.end}) put(state, poses);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    present_.inverse[i].mass = moves_[i] ? 1 / world.bodies.mass[bodies_[i]] : 0;
  }
  turnInertia();
  lookAt(trial.start, trial, world, 1);
}

void SymmetricStep::set(const IslandState& state, const Surroundings& world,
                        const TrialPoses& trial) {
  put(state, world, trial);
  stop(0);
  measure(world, trial);
  first_ = present_;
}

void SymmetricStep::measure(const Surroundings& world, const TrialPoses& trial) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const auto reach = [&](const Vec3& x) { low = low.cwiseMin(x), high = high.cwiseMax(x); };
  JointRow row;
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    const JointShape& shape = topology_->shapes[i];
    if (!shape.pulls) continue;
    clear(row);
    evaluateRow(world.kinds, refs_[i], {trial.start, trial.start, 1}, row);
    for (int b = 0; row.active && b < shape.bodyCount; ++b) {
      const int place = shape.body[b];
      reach(trial.start[bodies_[place]].x + row.arm[b]);
      if (turns(place)) levers_[place] = std::max(levers_[place], row.arm[b].norm());
    }
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!moves_[i]) continue;
    reach(trial.start[bodies_[i]].x);
    size_ = std::max(size_, boundingRadius(world.bodies.shape[bodies_[i]]));
    size_ = std::max(size_, levers_[i]);
  }
  size_ = std::max(size_, (high - low).norm());
}

bool SymmetricStep::project(const IslandState& state, double tolerance, const Surroundings& world,
                            const TrialPoses& trial) {
  put(state, world, trial);
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    if (!isForce_[i]) present_.rows[i] = ahead_[i];
    present_.rows[i].solved = !isForce_[i];
  }
  if (!refs_.empty()) present_.joints.factorize(present_.rows, present_.inverse);
  bool closed = false;
  for (int k = 0; k < kMostIterations && !closed; ++k) {
    double most = 0;
    for (std::size_t i = 0; i < refs_.size(); ++i) {
      if (isForce_[i]) error_[i].setZero();
      most = std::max(most, error_[i].cwiseAbs().maxCoeff());
      lambda_[i] = -error_[i];
    }
    closed = most <= tolerance;
    if (closed) break;
    present_.joints.solve(lambda_);
    sum();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!moves_[i]) continue;
      displace(to_.pose[i], shift_[i], present_.inverse[i].inertia * twist_[i]);
      to_.pose[i].q.normalize();
    }
    put(to_, trial.start);
    lookAt(trial.start, trial, world, 1);
  }
  present_.state = to_;
  put(to_, trial.end);
  put(to_, trial.now);
  turnInertia();
  stop(0);
  first_ = present_;
  return closed;
}

template <class Change>
void SymmetricStep::changeSpins(IslandState& state, const Change& change) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!turns(i) || isIsotropic(inertia_[i])) continue;
    const Vec3 inside = state.pose[i].q.conjugate() * state.velocity[i].w;
    state.velocity[i].w = state.pose[i].q * change(i, inside);
  }
}

void SymmetricStep::takeMomenta(IslandState& state) const {
  changeSpins(state, [&](std::size_t i, const Vec3& omega) -> Vec3 {
    return inertia_[i].cwiseProduct(omega) / inertia_[i].maxCoeff();
  });
}

void SymmetricStep::takeSpins(IslandState& state) const {
  changeSpins(state, [&](std::size_t i, const Vec3& momentum) -> Vec3 {
    return inverseInertia_[i].cwiseProduct(momentum) * inertia_[i].maxCoeff();
  });
}

void SymmetricStep::restart() { present_ = first_; }

// `set` makes the rest anew.
void SymmetricStep::archive(Archive& a) {
  a(size_, levers_, present_.h);
  for (auto& [next, change] : present_.pulls) a(next, change);
}

}  // namespace physics
