// The matrix M + sum J^T K J of the implicit penalty method, by bodies: three unknowns of a point,
// six of a body that turns.
#pragma once

#include <span>
#include <vector>

#include "physics/bodies/body.h"
#include "physics/solver/sparse_factor.h"

namespace physics {

class SparseMotion {
 public:
  // M at bodies.start, and M (free - v) on the right.
  void begin(const Bodies& bodies, std::span<const Velocity> free);

  // Adds J^T K J over the bodies of one constraint; J is given per body, R rows, linear and angular
  // (absent: zero).
  template <int R, class Blocks>
  void addStiffness(std::span<const BodyId> ids, const Blocks& linear, const Blocks* angular,
                    const Eigen::Matrix<double, R, R>& k);

  // Adds a momentum and an angular momentum to the right-hand side.
  void addImpulse(BodyId body, const Vec3& linear, const Vec3& angular);

  // The changes of the velocities. False when the factor breaks down or they are not finite. What
  // has entries where it had them before is not laid out anew.
  bool solve(std::span<Velocity> change);

 private:
  int sizeOf(BodyId body) const { return first_[body + 1] - first_[body]; }
  void add(int row, int column, const Mat3& block);

  std::vector<int> first_;  // the first unknown of every body, and their number
  std::vector<std::array<int, 2>> entries_, laidOut_;
  std::vector<double> values_;  // of the entries
  Eigen::VectorXd right_, solution_;
  SparseFactor factor_;
};

template <int R, class Blocks>
void SparseMotion::addStiffness(std::span<const BodyId> ids, const Blocks& linear,
                                const Blocks* angular, const Eigen::Matrix<double, R, R>& k) {
  using Gradient = Eigen::Matrix<double, R, 3>;
  const auto block = [&](std::size_t b, int half) -> const Gradient& {
    return half == 0 ? linear[b] : (*angular)[b];
  };
  const auto halves = [&](std::size_t b) {
    return sizeOf(ids[b]) == 6 && angular != nullptr ? 2 : sizeOf(ids[b]) > 0 ? 1 : 0;
  };
  for (std::size_t a = 0; a < ids.size(); ++a) {
    for (int i = 0; i < halves(a); ++i) {
      const Eigen::Matrix<double, 3, R> left = block(a, i).transpose() * k;
      for (std::size_t b = 0; b < ids.size(); ++b) {
        for (int j = 0; j < halves(b); ++j) {
          const int row = first_[ids[a]] + 3 * i, column = first_[ids[b]] + 3 * j;
          if (row >= column) add(row, column, left * block(b, j));
        }
      }
    }
  }
}

}  // namespace physics
