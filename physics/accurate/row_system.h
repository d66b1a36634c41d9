// The rows of an island and A = J M^-1 J^T + alpha, factored as L D L^T in blocks of three, in the
// order of its topology: no fill for chains and trees.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/solver/joint_topology.h"

namespace physics {

// J of one row by its two bodies, rows that it does not have being zero.
struct IslandRow {
  enum class Form : char { kRows, kSingle, kGap };
  // Single: a row of one number. A gap: J is 1 and -[arm]x for the first body, the opposite for the
  // second, (72).
  Form form = Form::kRows;
  bool solved = true;                          // false: its multiplier is given
  Vec3 arm[2] = {Vec3::Zero(), Vec3::Zero()};  // of a gap, world
  Mat3 linear[2] = {Mat3::Zero(), Mat3::Zero()}, angular[2] = {Mat3::Zero(), Mat3::Zero()};
  Mat3 alpha = Mat3::Zero();
};

// M^-1 of a body, world.
struct BodyInverse {
  double mass = 0;              // 1/kg
  Mat3 inertia = Mat3::Zero();  // 1/(kg m^2)
  bool turns = false;           // else that is zero
};

// J^T lambda of one of its bodies, added up.
inline void addPull(const IslandRow& row, int b, const Vec3& lambda, Vec3& along, Vec3& about) {
  if (row.form == IslandRow::Form::kGap) {
    const Vec3 pull = b == 0 ? lambda : -lambda;
    along += pull;
    about += row.arm[b].cross(pull);
  } else if (row.form == IslandRow::Form::kSingle) {
    along += row.linear[b].row(0).transpose() * lambda[0];
    about += row.angular[b].row(0).transpose() * lambda[0];
  } else {
    along += row.linear[b].transpose() * lambda;
    about += row.angular[b].transpose() * lambda;
  }
}

// J v of one of its bodies.
inline Vec3 opening(const IslandRow& row, int b, const Vec3& v, const Vec3& w) {
  if (row.form == IslandRow::Form::kSingle) {
    return {row.linear[b].row(0).dot(v) + row.angular[b].row(0).dot(w), 0, 0};
  }
  if (row.form == IslandRow::Form::kRows) return row.linear[b] * v + row.angular[b] * w;
  const Vec3 at = v + w.cross(row.arm[b]);
  return b == 0 ? at : -at;
}

// J_k M^-1 J_i^T of a body that is at place p of row k and q of row i.
Mat3 couple(const IslandRow& k, int p, const IslandRow& i, int q, const BodyInverse& body);

// Keeps a factor regular where rows repeat each other (loops): relative to the row's own A. What it
// leaves of an error the next iteration takes. NOTES 3.5
constexpr double kRepeated = 1e-11;

class RowSystem {
 public:
  RowSystem() = default;
  explicit RowSystem(std::shared_ptr<const JointTopology> topology);
  void factorize(std::span<const IslandRow> rows, std::span<const BodyInverse> bodies);
  void solve(std::span<Vec3> right) const;  // right <- A^-1 right

 private:
  void build(std::span<const IslandRow> rows, std::span<const BodyInverse> bodies);
  template <int N, int K>
  void eliminate(int row);
  template <int N>
  void solveBlocks(std::span<Vec3> right) const;
  std::shared_ptr<const JointTopology> topology_;
  std::vector<Mat3> diagonal_;          // then D^-1
  std::vector<Mat3> entries_, scaled_;  // A_ki and L_ki, by block
  bool isSingle_ = false;               // all rows are: of every block only the first number counts
};

}  // namespace physics
