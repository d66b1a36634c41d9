// The linear system (J M^-1 J^T + alpha) dlambda = right of all joints together, sparse.
// Two joints meet in it where they share a body that moves. Its factor LDL^T in a minimum-degree
// order has no fill for chains and trees, so that its cost is linear in the joints; a loop adds a
// little.
#pragma once

#include <span>
#include <vector>

#include "physics/bodies/body.h"
#include "physics/constraints/constraint.h"
#include "physics/solver/sparse_factor.h"

namespace physics {

// The rows of one joint, padded to three.
struct JointRows {
  static constexpr int kMostRows = 3;
  std::array<BodyId, 2> bodies{};
  const char* word = "";    // its kind's
  std::size_t item = 0;     // in the kind's set
  double* total = nullptr;  // the multiplier of the first row; the others' follow it
  double regularisation = 0;
  int first = 0, rows = 0;
  double alpha = 0;
  double error = 0;                     // |c|
  int side = 0;                         // 1: lambda >= 0, -1: <= 0, 0: any
  bool changes = false;                 // it held, and has been let go
  bool isSymmetric = false;             // J is that of the start of the step
  Vec3 right = Vec3::Zero();            // -(c + alpha lambda) + J M^-1 r, of the motion
  std::array<Mat3, 2> linear, angular;  // J, one row per constraint row
  std::array<Mat3, 2> responseLinear, responseAngular;  // (M + K)^-1 J^T, one column per row

  int end() const { return first + rows; }
  Vec3 totals() const {  // padded
    Vec3 padded = Vec3::Zero();
    for (int r = 0; r < rows; ++r) padded[r] = total[r];
    return padded;
  }
};

// What all joints together do to one body in a substep.
struct JointMotion {
  Vec3 dx = Vec3::Zero(), dtheta = Vec3::Zero();       // displacement so far
  Vec3 impulse = Vec3::Zero(), torque = Vec3::Zero();  // J^T lambda at the present pose, times h^2
  Mat3 stiffnessLinear = Mat3::Zero(), stiffnessAngular = Mat3::Zero();  // K, geometric
  Mat3 inverseLinear = Mat3::Zero(), inverseAngular = Mat3::Zero();      // (M + K)^-1
  Vec3 lagLinear = Vec3::Zero(), lagAngular = Vec3::Zero();  // (M + K)^-1 (M dX - J^T lambda)
};

class JointSystem {
 public:
  // Takes the joints' bodies and row counts; needed again only when these change.
  void layOut(std::span<const JointRows> joints, const Bodies& bodies);
  bool isLaidOutFor(std::size_t joints) const;

  // False when it breaks down.
  bool factorize(std::span<const JointRows> joints);

  // Writes the change of every joint's multipliers to `change`.
  void solve(std::span<const JointRows> joints, std::span<Vec3> change);

 private:
  std::size_t joints_ = 0;
  std::vector<std::array<int, 2>> pairs_;  // later, earlier: blocks of the lower triangle
  std::vector<bool> moves_;
  SparseFactor factor_;
  Eigen::VectorXd right_, solution_;
};

}  // namespace physics
