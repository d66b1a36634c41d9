// The paper's method, for tests of what it does: a test that says no method is of the default one.
#pragma once

#include "physics/model/settings.h"

namespace physics::testing {

// Settings of the sweep over all constraints, (52); the rest as by default.
inline Settings sweeps(int iterations = 8) {
  Settings settings;
  settings.iterations = iterations;
  settings.method = Method::kNonlinearGaussSeidel;
  return settings;
}

}  // namespace physics::testing
