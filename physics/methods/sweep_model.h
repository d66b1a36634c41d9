// What the sweeps of the paper's methods keep beside the model.
#pragma once

#include "physics/methods/conjugate.h"
#include "physics/methods/joint_system.h"
#include "physics/methods/linear_gauss_seidel.h"
#include "physics/model/model.h"

namespace physics {

struct SweepModel : Model {
  Conjugate conjugate;  // scratch
  JointSystem joints;   // this and its scratch: the direct method only
  std::vector<JointRows> jointRows;
  std::vector<Vec3> jointChange;
  std::vector<JointMotion> jointMotion;
  double jointError = 0;  // largest that the last Newton step met [m or rad]; infinite while its
                          // active set changes
  LinearSystem linear;    // the linear method only
};

}  // namespace physics
