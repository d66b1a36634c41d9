// Items that stand still: out of the lists that a look walks, and back.
#include <algorithm>
#include <limits>

#include "physics/base/sorted.h"
#include "physics/collision/pairs.h"
#include "physics/collision/triangle_tree.h"

namespace physics::collision {
namespace {

template <class T>
std::size_t bytesOf(const std::vector<T>& list) {
  return list.capacity() * sizeof(T);
}

bool byItems(const Watch& p, const Watch& q) { return p.items() < q.items(); }

}  // namespace

void Pairs::rest(std::span<const BodyId> bodies, std::span<const Pose> poses) {
  for (const BodyId body : bodies) {
    const int first = indexOf(body);
    for (int i = first; i < endOf(first); ++i) {
      if (items_[i].rests) continue;
      items_[i].rests = true;
      takeMotion(i, poses[body], poses[body]);
      moved_[i] = 0;
      late_.push_back(i);
    }
  }
  std::erase_if(moving_, [&](int i) { return items_[i].rests; });
  carry(watches_, parked_, byItems, [&](const Watch& watch) { return bothRest(watch); });
}

void Pairs::wake(std::span<const BodyId> bodies) {
  const double nowhere = std::numeric_limits<double>::infinity();
  const auto middle = static_cast<std::ptrdiff_t>(moving_.size());
  for (const BodyId body : bodies) {
    const int first = indexOf(body);
    for (int i = first; i < endOf(first); ++i) {
      if (!items_[i].rests) continue;
      items_[i].rests = false;
      fat_[i] = {Vec3::Constant(nowhere),
                 Vec3::Constant(-nowhere)};  // its pairs are looked for anew
      moving_.push_back(i);
    }
  }
  std::inplace_merge(moving_.begin(), moving_.begin() + middle, moving_.end());
  std::erase_if(late_, [&](int i) { return !items_[i].rests; });
  carry(parked_, watches_, byItems, [&](const Watch& watch) { return !bothRest(watch); });
}

// Of the pairs that there are, how many are ignored? Points never touch one another, nor do the
// parts of a body.
bool Pairs::canTouch() const {
  std::int64_t solids = 0, points = 0, fixedSolids = 0, fixedPoints = 0;
  for (const Item& item : items_) {
    const bool isPoint = item.solid.kind == SolidKind::point;
    (isPoint ? points : solids) += 1;
    if (!item.movable) (isPoint ? fixedPoints : fixedSolids) += 1;
  }
  const auto among = [](std::int64_t n, std::int64_t m) { return n * (n - 1) / 2 + n * m; };
  std::int64_t pairs = among(solids, points) - among(fixedSolids, fixedPoints);
  const auto partsOf = [&](int first) { return static_cast<std::int64_t>(endOf(first) - first); };
  for (const int first : indexOf_) {
    if (first >= 0 && items_[first].movable) pairs -= partsOf(first) * (partsOf(first) - 1) / 2;
  }
  for (const auto& [a, b] : ignored_) {
    const int p = indexOf(a), q = indexOf(b);
    if (p < 0 || q < 0 || (!items_[p].movable && !items_[q].movable)) continue;
    const bool points =
        items_[p].solid.kind == SolidKind::point && items_[q].solid.kind == SolidKind::point;
    pairs -= points ? 0 : partsOf(p) * partsOf(q);
  }
  return pairs > 0;
}

std::size_t Pairs::bytes() const {
  std::size_t sum = bytesOf(items_) + bytesOf(told_) + bytesOf(fat_) + bytesOf(indexOf_) +
                    bytesOf(planes_) + bytesOf(moving_) + bytesOf(late_) + bytesOf(treeIndex_) +
                    bytesOf(itemOfTree_) + bytesOf(ignored_) + bytesOf(fresh_) + bytesOf(parked_) +
                    bytesOf(watches_) + bytesOf(merged_) + bytesOf(findings_) + bytesOf(free_) +
                    bytesOf(moved_) + bytesOf(movedTree_) + bytesOf(treeBounds_) +
                    bytesOf(parted_) + bytesOf(watchedAt_) + bytesOf(others_) + bytesOf(freshAt_) +
                    bytesOf(offers_) + tree_.bytes();
  for (const Offers& offers : offers_) sum += bytesOf(offers.found) + bytesOf(offers.fresh);
  for (const Item& item : items_) {
    sum += bytesOf(item.solid.edges);
    if (item.solid.triangles) sum += item.solid.triangles->bytes();
  }
  return sum;
}

}  // namespace physics::collision
