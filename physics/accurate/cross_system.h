// The rows of an island where a step ends against where it began: A = J' M^-1 J^T + alpha, factored
// as L D U in the order of the island's topology.
#pragma once

#include "physics/accurate/row_system.h"

namespace physics {

class CrossSystem {
 public:
  CrossSystem() = default;
  explicit CrossSystem(std::shared_ptr<const JointTopology> topology);
  void factorize(std::span<const IslandRow> ends, std::span<const IslandRow> starts,
                 std::span<const BodyInverse> bodies);
  void solve(std::span<Vec3> right) const;

 private:
  void build(std::span<const IslandRow> ends, std::span<const IslandRow> starts,
             std::span<const BodyInverse> bodies);
  void eliminate(int row);
  std::shared_ptr<const JointTopology> topology_;
  std::vector<Mat3> diagonal_;       // then D^-1
  std::vector<Mat3> lower_, upper_;  // A_ki, then L_ki; A_ik
};

}  // namespace physics
