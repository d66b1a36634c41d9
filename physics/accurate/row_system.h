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
  Mat3 linear[2] = {Mat3::Zero(), Mat3::Zero()}, angular[2] = {Mat3::Zero(), Mat3::Zero()};
  Mat3 alpha = Mat3::Zero();
  bool solved = true;  // false: its multiplier is given
};

// M^-1 of a body, world.
struct BodyInverse {
  double mass = 0;              // 1/kg
  Mat3 inertia = Mat3::Zero();  // 1/(kg m^2)
  bool turns = false;           // else that is zero
};

// J_k M^-1 J_i^T of a body that is at place p of row k and q of row i.
inline Mat3 couple(const IslandRow& k, int p, const IslandRow& i, int q, const BodyInverse& body) {
  Mat3 sum = body.mass * (k.linear[p] * i.linear[q].transpose());
  if (body.turns) sum += k.angular[p] * (body.inertia * i.angular[q].transpose());
  return sum;
}

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
  void eliminate(int row);
  void eliminateSingle(int row);
  std::shared_ptr<const JointTopology> topology_;
  std::vector<Mat3> diagonal_;          // then D^-1
  std::vector<Mat3> entries_, scaled_;  // A_ki and L_ki, by block
};

}  // namespace physics
