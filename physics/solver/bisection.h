// Recursive coordinate bisection (Berger and Bokhari 1987): bodies that are near each other come
// together, in parts of equal size that few contacts cross.
#pragma once

#include <span>
#include <vector>

#include "physics/base/workers.h"
#include "physics/bodies/body.h"

namespace physics {

class Bisection {
 public:
  // Sorts `bodies` into 2^levels parts, each half of what the level before had, cut across where
  // that is the widest. Positions are to be finite.
  void divide(std::span<const Pose> pose, int levels, std::span<BodyId> bodies, Workers& workers);
  // The part of the k-th of them.
  int partOf(std::size_t k) const { return parts_[k]; }

 private:
  struct Place {
    Vec3 x;
    BodyId body;
  };
  std::size_t cut(std::size_t from, std::size_t to);  // where its second half begins
  std::vector<Place> places_;
  std::vector<std::size_t> starts_, halves_;  // of the parts of a level, and of the next one
  std::vector<int> parts_;
};

}  // namespace physics
