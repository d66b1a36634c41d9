// Recursive coordinate bisection (Berger and Bokhari 1987): bodies that are near each other come
// together, in parts of equal size that few contacts cross.
#pragma once

#include <span>
#include <vector>

#include "physics/bodies/body.h"

namespace physics {

class Bisection {
 public:
  // Sorts `bodies` into 2^levels parts, each half of what the level before had, cut across where
  // that is the widest. Positions are to be finite.
  void divide(std::span<const Pose> pose, int levels, std::span<BodyId> bodies);
  // The part of the k-th of them.
  int partOf(std::size_t k) const { return parts_[k]; }

 private:
  struct Place {
    Vec3 x;
    BodyId body;
  };
  void divide(std::size_t from, std::size_t to, int levels, int part);
  std::vector<Place> places_;
  std::vector<int> parts_;
};

}  // namespace physics
