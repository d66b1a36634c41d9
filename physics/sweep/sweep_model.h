// What the sweeps of the paper's methods keep beside the model.
#pragma once

#include "physics/model/model.h"
#include "physics/sweep/joint_system.h"
#include "physics/sweep/linear_gauss_seidel.h"

namespace physics {

struct SweepModel : Model {
  JointSystem joints;  // this and its scratch: the direct method only
  std::vector<JointRows> jointRows;
  std::vector<Vec3> jointChange;
  std::vector<JointMotion> jointMotion;
  double jointError = 0;  // largest that the last Newton step met [m or rad]; infinite while its
                          // active set changes
  FrozenRows frozen;      // the linear method, and rivals
  LinearSystem linear;    // the linear method only
  std::vector<Pose> iterate;  // before the last sweep, where a tolerance is given
};

}  // namespace physics
