#include "physics/solver/bisection.h"

#include <algorithm>

namespace physics {

void Bisection::divide(std::span<const Pose> pose, int levels, std::span<BodyId> bodies,
                       Workers& workers) {
  parts_.assign(bodies.size(), 0);
  if (levels == 0) return;
  places_.clear();
  for (const BodyId i : bodies) places_.push_back({pose[i].x, i});
  starts_ = {0, places_.size()};
  for (int level = 0; level < levels; ++level) {
    const int count = static_cast<int>(starts_.size()) - 1;
    halves_.resize(2 * count + 1);
    halves_.back() = places_.size();
    workers.forEachChunk(count, 1, [&](int first, int last) {
      for (int part = first; part < last; ++part) {
        halves_[2 * part] = starts_[part];
        halves_[2 * part + 1] = cut(starts_[part], starts_[part + 1]);
      }
    });
    std::swap(starts_, halves_);
  }
  workers.forEachChunk(static_cast<int>(starts_.size()) - 1, 1, [&](int first, int last) {
    for (int part = first; part < last; ++part) {
      const auto from = places_.begin() + static_cast<std::ptrdiff_t>(starts_[part]),
                 to = places_.begin() + static_cast<std::ptrdiff_t>(starts_[part + 1]);
      std::sort(from, to, [](const Place& a, const Place& b) { return a.body < b.body; });
      for (std::size_t k = starts_[part]; k < starts_[part + 1]; ++k) {
        bodies[k] = places_[k].body;
        parts_[k] = part;
      }
    }
  });
}

std::size_t Bisection::cut(std::size_t from, std::size_t to) {
  if (to - from < 2) return to;
  Vec3 low = places_[from].x, high = low;
  for (std::size_t k = from; k < to; ++k) {
    low = low.cwiseMin(places_[k].x);
    high = high.cwiseMax(places_[k].x);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = (from + to) / 2;
  const auto at = [&](std::size_t k) { return places_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(from), at(middle), at(to), [axis](const Place& a, const Place& b) {
    return a.x[axis] != b.x[axis] ? a.x[axis] < b.x[axis] : a.body < b.body;
  });
  return middle;
}

}  // namespace physics
