// Conjugate acceleration of the contact sweeps (Silcowitz, Niebe and Erleben, "A nonsmooth
// nonlinear conjugate gradient method for interactive contact force problems", 2010): a sweep's
// change of the multipliers is taken for a gradient, and the sweeps go on along conjugate
// directions. Tall stacks and large mass ratios then need about the square root of the sweeps. A
// sweep that makes things worse restarts it.
#pragma once

#include <vector>

#include "physics/constraints/contact.h"

namespace physics {

class Conjugate {
 public:
  void begin(const Contacts& contacts);  // before the first sweep
  void accelerate(Contacts& contacts,
                  Bodies& bodies);  // after each pair of sweeps, forwards and backwards

  std::size_t bytes() const { return (before_.capacity() + direction_.capacity()) * sizeof(Vec3); }

 private:
  std::vector<Vec3> before_, direction_;  // per contact point, world, times h^2
  double last_ = 0;                       // weighted square of the last gradient
};

}  // namespace physics
