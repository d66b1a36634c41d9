// Random numbers that are the same with every compiler and library.
#pragma once

#include <random>

#include "physics/base/types.h"

namespace physics::testing {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double within(double size) { return size * (random_() / 2147483648.0 - 1); }  // +-size
  Vec3 anywhere(double size) {
    const double x = within(size), y = within(size);
    return {x, y, within(size)};
  }

 private:
  std::mt19937 random_;
};

}  // namespace physics::testing
