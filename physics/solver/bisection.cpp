#include "physics/solver/bisection.h"

#include <algorithm>

namespace physics {

void Bisection::divide(std::span<const Pose> pose, int levels, std::span<BodyId> bodies) {
  parts_.assign(bodies.size(), 0);
  if (levels == 0) return;
  places_.clear();
  for (const BodyId i : bodies) places_.push_back({pose[i].x, i});
  divide(0, places_.size(), levels, 0);
  for (std::size_t k = 0; k < bodies.size(); ++k) bodies[k] = places_[k].body;
}

void Bisection::divide(std::size_t from, std::size_t to, int levels, int part) {
  const auto at = [&](std::size_t k) { return places_.begin() + static_cast<std::ptrdiff_t>(k); };
  if (levels == 0 || to - from < 2) {
    const auto byBody = [](const Place& a, const Place& b) { return a.body < b.body; };
    std::sort(at(from), at(to), byBody);
    std::fill_n(parts_.begin() + static_cast<std::ptrdiff_t>(from), to - from, part << levels);
    return;
  }
  Vec3 low = places_[from].x, high = low;
  for (std::size_t k = from; k < to; ++k) {
    low = low.cwiseMin(places_[k].x);
    high = high.cwiseMax(places_[k].x);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = (from + to) / 2;
  std::nth_element(at(from), at(middle), at(to), [axis](const Place& a, const Place& b) {
    return a.x[axis] != b.x[axis] ? a.x[axis] < b.x[axis] : a.body < b.body;
  });
  divide(from, middle, levels - 1, 2 * part);
  divide(middle, to, levels - 1, 2 * part + 1);
}

}  // namespace physics
