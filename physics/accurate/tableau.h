// Aitken and Neville's tableau over the end states of a motion: T_j1 by steps H/n_j, whose error
// has powers of h^p, and
//   T_jk = T_j,k-1 + (T_j,k-1 - T_j-1,k-1) / ((n_j/n_j-k+1)^p - 1)
// without the first k - 1 of them. Turns are added up as vectors, from the orientation that T_11
// ended with.
#pragma once

#include <span>
#include <vector>

#include "physics/base/types.h"

namespace physics {

class Tableau {
 public:
  static constexpr int kMostRows = 7;  // order 14, where the error has even powers

  // For so many bodies, from the beginning.
  void clear(std::size_t bodies);
  // The next T_j1, of n_j steps, by body.
  void add(int steps, int power, std::span<const Pose> pose, std::span<const Velocity> velocity);
  int rows() const { return count_; }

  // T_kk.
  void best(std::span<Pose> pose, std::span<Velocity> velocity) const;
  // What T_kk and T_k,k-1 differ by, over `size`: by body the larger of its points' way and speed *
  // time, which reach so far as its lever. Infinite where it is not a number.
  // `places`: of how many bodies it is more than `allowed`.
  double difference(double size, double time, std::span<const double> levers, double allowed = 0,
                    int* places = nullptr) const;

  // What T_kk and T_k1 differ by.
  double gain(double size, double time, std::span<const double> levers) const;

 private:
  struct Numbers {
    Vec3 x, turn, v, w;
  };
  using Row = std::vector<Numbers>;
  std::size_t size_ = 0;
  int count_ = 0, steps_[kMostRows] = {};
  Row rows_[kMostRows];  // [m]: T_j,j-m of the last j
  Row before_, last_;    // T_k,k-1, T_k1
  double between(const Row& a, const Row& b, double size, double time,
                 std::span<const double> levers, double allowed, int* places) const;
  std::vector<Quat> reference_;
};

}  // namespace physics
