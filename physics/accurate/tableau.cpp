// Aitken and Neville's tableau.
#include "physics/accurate/tableau.h"

#include <algorithm>
#include <limits>

#include "physics/base/rotation.h"

namespace physics {

void Tableau::clear(std::size_t bodies) {
  size_ = bodies;
  count_ = 0;
  for (Row& row : rows_) row.resize(std::max(row.size(), bodies));
  before_.resize(std::max(before_.size(), bodies));
  last_.resize(before_.size());
  reference_.resize(std::max(reference_.size(), bodies));
}

void Tableau::add(int steps, int power, std::span<const Pose> pose,
                  std::span<const Velocity> velocity) {
  Row& fine = rows_[count_];
  for (std::size_t i = 0; i < size_; ++i) {
    if (count_ == 0) reference_[i] = pose[i].q;
    const Vec3 turn = count_ == 0 ? Vec3::Zero() : logarithm(pose[i].q * reference_[i].conjugate());
    fine[i] = {pose[i].x, turn, velocity[i].v, velocity[i].w};
  }
  steps_[count_] = steps;
  std::copy_n(fine.begin(), size_, last_.begin());
  for (int m = count_ - 1; m >= 0; --m) {
    if (m == 0) std::copy_n(rows_[1].begin(), size_, before_.begin());
    const double ratio = static_cast<double>(steps) / steps_[m];
    const double factor = 1 / ((power == 2 ? ratio * ratio : ratio) - 1);
    for (std::size_t i = 0; i < size_; ++i) {
      Numbers& to = rows_[m][i];
      const Numbers& by = rows_[m + 1][i];
      to.x = by.x + factor * (by.x - to.x);
      to.turn = by.turn + factor * (by.turn - to.turn);
      to.v = by.v + factor * (by.v - to.v);
      to.w = by.w + factor * (by.w - to.w);
    }
  }
  ++count_;
}

void Tableau::best(std::span<Pose> pose, std::span<Velocity> velocity) const {
  for (std::size_t i = 0; i < size_; ++i) {
    const Numbers& of = rows_[0][i];
    pose[i] = {of.x, (exponential(of.turn) * reference_[i]).normalized()};
    velocity[i] = {of.v, of.w};
  }
}

double Tableau::difference(double size, double time, std::span<const double> levers, double allowed,
                           int* places) const {
  return between(rows_[0], before_, size, time, levers, allowed, places);
}

double Tableau::gain(double size, double time, std::span<const double> levers) const {
  return between(rows_[0], last_, size, time, levers, 0, nullptr);
}

double Tableau::between(const Row& of, const Row& other, double size, double time,
                        std::span<const double> levers, double allowed, int* places) const {
  double most = 0;
  bool isNumber = true;
  int count = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    const Numbers &a = of[i], &b = other[i];
    const double way = (a.x - b.x).norm() + levers[i] * (a.turn - b.turn).norm();
    const double speed = (a.v - b.v).norm() + levers[i] * (a.w - b.w).norm();
    const double error = std::max(way, time * speed) / size;
    isNumber = isNumber && error == error;
    most = std::max(most, error);
    count += error > allowed;
  }
  if (places != nullptr) *places = count;
  return isNumber ? most : std::numeric_limits<double>::infinity();
}

}  // namespace physics
