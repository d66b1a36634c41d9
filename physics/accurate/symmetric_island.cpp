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

// Joints close as far as numbers tell where bodies are: in a few roundings of what an island
// measures, and of how far from the origin it is.
constexpr double kFinest = 1e-14, kFinestPlace = 1e-15;

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

// m; 0: it is no link.
double lengthOf(const Kinds& kinds, JointRef ref) {
  double length = 0;
  int place = 0;
  forEachKind(kinds, [&](const auto& kind) {
    if constexpr (std::is_same_v<typename std::decay_t<decltype(kind)>::Item, Link>) {
      if (place == ref.kind) length = kind.set.items[ref.item].length;
    }
    ++place;
  });
  return length;
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
    const std::array<double, kJointFixed>& fixed = kinds[i].fixed;
    anchors_.push_back({Vec3(fixed[0], fixed[1], fixed[2]), Vec3(fixed[3], fixed[4], fixed[5])});
  }
  isSeenAway_ = !limits_.empty();
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
  if (isLoop()) across_ = CrossSystem(topology_);
  present_.rows.resize(rows);
  present_.pulls.resize(rows);
  present_.inverse.resize(size);
  spins_.resize(size);
  ahead_.resize(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    present_.rows[i].solved = ahead_[i].solved = !isForce_[i];
    const JointShape& shape = topology_->shapes[i];
    using Form = IslandRow::Form;
    const Form form = shape.isGap ? Form::kGap : shape.rows == 1 ? Form::kSingle : Form::kRows;
    present_.rows[i].form = ahead_[i].form = form;
    isSeenAway_ = isSeenAway_ || !shape.isGap;
  }
  std::vector<JointTree::Body> of;
  for (std::size_t i = 0; i < size; ++i) {
    of.push_back({moves_[i], turns(i), world.bodies.mass[bodies_[i]], inertia_[i]});
  }
  std::vector<JointTree::Joint> joints;
  for (std::size_t i = 0; i < rows; ++i) {
    joints.push_back({anchors_[i], lengthOf(world.kinds, refs_[i])});
  }
  tree_ = JointTree::of(topology_, joints, of);
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
  lookAt(to_, trial.start, trial, world, 1);
}

bool SymmetricStep::isAt(const IslandState& state) const {
  const IslandState& here = present_.state;
  const auto same = [](const Pose& a, const Pose& b) {
    return a.x == b.x && a.q.coeffs() == b.q.coeffs();
  };
  return std::equal(here.pose.begin(), here.pose.end(), state.pose.begin(), state.pose.end(),
                    same) &&
         std::equal(here.velocity.begin(), here.velocity.end(), state.velocity.begin(),
                    state.velocity.end(),
                    [](const Velocity& a, const Velocity& b) { return a.v == b.v && a.w == b.w; });
}

void SymmetricStep::set(const IslandState& state, const Surroundings& world,
                        const TrialPoses& trial) {
  const bool isThere = isAt(state);
  if (!isThere || !isMade_) {
    put(state, world, trial);
    if (isThere) {
      takeRows();
    } else {
      stop(0);
    }
    isMade_ = true;
    first_ = present_;
    hasStepped_ = false;
  } else {
    put(state, trial.start);
  }
  measure(world, trial);
}

// The largest of its points.
double SymmetricStep::speedOf(std::size_t place, const Velocity& velocity) const {
  return velocity.v.norm() + levers_[place] * velocity.w.norm();
}

void SymmetricStep::measure(const Surroundings& world, const TrialPoses& trial) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const auto reach = [&](const Vec3& x) { low = low.cwiseMin(x), high = high.cwiseMax(x); };
  JointRow row;
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    const JointShape& shape = topology_->shapes[i];
    if (!shape.pulls) continue;
    const bool isGap = shape.isGap;
    if (!isGap) {
      clear(row);
      evaluateRow(world.kinds, refs_[i], {trial.start, trial.start, 1}, row);
      if (!row.active) continue;
    }
    for (int b = 0; b < shape.bodyCount; ++b) {
      const int place = shape.body[b];
      const Pose& pose = present_.state.pose[place];
      const Vec3 arm = isGap ? pose.q * anchors_[i][b] : row.arm[b];
      reach(pose.x + arm);
      if (turns(place)) levers_[place] = std::max(levers_[place], arm.norm());
    }
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!moves_[i]) continue;
    reach(present_.state.pose[i].x);
    size_ = std::max(size_, boundingRadius(world.bodies.shape[bodies_[i]]));
    size_ = std::max(size_, levers_[i]);
    speed_ = std::max(speed_, speedOf(i, present_.state.velocity[i]));
  }
  size_ = std::max(size_, (high - low).norm());
  const double far = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  finest_ = std::max(kFinest * size_, kFinestPlace * far);
}

bool SymmetricStep::project(const IslandState& state, double tolerance, const Surroundings& world,
                            const TrialPoses& trial) {
  put(state, world, trial);
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
    lookAt(to_, trial.start, trial, world, 1);
  }
  present_.state = to_;
  put(to_, trial.end);
  put(to_, trial.now);
  turnInertia();
  stop(0);
  first_ = present_;
  hasStepped_ = false;
  return closed;
}

bool SymmetricStep::stepSideBySide(int first, int columns, double time, const Surroundings& world,
                                   const TrialPoses& trial) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    shift_[i] = pullOn(i, world);
    twist_[i] = world.loads[bodies_[i]].torque;
  }
  tree_->push(shift_, twist_);
  tree_->run(first, columns, present_.state, time);
  put(present_.state, trial.start);
  for (int row = 0; row < columns && !limits_.empty(); ++row) {
    tree_->end(row, to_);
    put(to_, trial.end);
    if (meetsLimit(world, trial)) return false;
  }
  return true;
}

void SymmetricStep::goOnFrom(const IslandState& state, const TrialPoses& trial) {
  present_.state = state;
  tree_->place(present_.state);
  for (const std::span<Pose> poses : {trial.now, trial.start, trial.end}) {
    put(present_.state, poses);
  }
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

void SymmetricStep::restart() {
  if (hasStepped_) present_ = first_;
  hasStepped_ = false;
  jump_ = 0;
}

// `set` makes the rest anew, of the same pose.
void SymmetricStep::archive(Archive& a) {
  a(size_, speed_, levers_, present_.h, present_.state.pose, present_.state.velocity);
  for (auto& [next, change] : present_.pulls) a(next, change);
  if (a.reads()) isMade_ = false;
}

}  // namespace physics
