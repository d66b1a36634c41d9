// The matrix of the implicit penalty method.
#include "physics/rivals/penalty_system.h"

#include "physics/base/rotation.h"

namespace physics {
namespace {

// I in the world frame. A zero moment means that the body does not turn about that axis.
Mat3 inertiaOf(const Bodies& bodies, BodyId body) {
  constexpr double kRigid = 1e9;
  Vec3 inertia = bodies.inertia[body];
  const double sum = inertia.sum();
  for (int k = 0; k < 3; ++k) inertia[k] = inertia[k] > 0 ? inertia[k] : kRigid * sum;
  const Mat3 rotation = bodies.start[body].q.toRotationMatrix();
  return rotation * inertia.asDiagonal() * rotation.transpose();
}

}  // namespace

void SparseMotion::begin(const Bodies& bodies, std::span<const Velocity> free) {
  entries_.clear();
  values_.clear();
  first_.assign(1, 0);
  for (BodyId body = 0; body < bodies.size(); ++body) {
    const bool moves = bodies.motion[body] == Motion::kDynamic;
    const bool turns = moves && !bodies.inverseInertia[body].isZero(0);
    first_.push_back(first_.back() + (turns ? 6 : moves ? 3 : 0));
  }
  right_.setZero(first_.back());
  for (BodyId body = 0; body < bodies.size(); ++body) {
    const int row = first_[body], size = sizeOf(body);
    if (size == 0) continue;
    const Velocity& v = bodies.velocity[body];
    add(row, row, bodies.mass[body] * Mat3::Identity());
    right_.segment<3>(row) = bodies.mass[body] * (free[body].v - v.v);
    if (size < 6) continue;
    const Mat3 inertia = inertiaOf(bodies, body);
    add(row + 3, row + 3, inertia);
    right_.segment<3>(row + 3) = inertia * (free[body].w - v.w);
  }
}

// The lower triangle.
void SparseMotion::add(int row, int column, const Mat3& block) {
  for (int j = 0; j < 3; ++j) {
    for (int i = row == column ? j : 0; i < 3; ++i) {
      entries_.push_back({row + i, column + j});
      values_.push_back(block(i, j));
    }
  }
}

void SparseMotion::addImpulse(BodyId body, const Vec3& linear, const Vec3& angular) {
  const int row = first_[body], size = sizeOf(body);
  if (size > 0) right_.segment<3>(row) += linear;
  if (size == 6) right_.segment<3>(row + 3) += angular;
}

bool SparseMotion::solve(std::span<Velocity> change) {
  if (entries_ != laidOut_) {
    factor_.layOut(entries_);
    laidOut_ = entries_;
  }
  factor_.begin();
  for (const double value : values_) factor_.give(value);
  if (!factor_.factorize()) return false;
  factor_.solve(right_, solution_);
  for (std::size_t body = 0; body + 1 < first_.size(); ++body) {
    const int row = first_[body], count = sizeOf(static_cast<BodyId>(body));
    change[body] = {};
    if (count > 0) change[body].v = solution_.segment<3>(row);
    if (count == 6) change[body].w = solution_.segment<3>(row + 3);
  }
  return solution_.allFinite();
}

}  // namespace physics
