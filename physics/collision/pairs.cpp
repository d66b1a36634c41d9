// Fat bounds, and the sorted list of pairs whose fat bounds overlap.
#include "physics/collision/pairs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

namespace physics::collision {
namespace {

constexpr double kSlack = 0.04;  // of the size: how much bounds are fatter than they must be
constexpr double kAhead = 4;     // steps of the present motion that the bounds hold
// m: bodies lie no further along a plane that turns; what a step turns it by counts so far out.
constexpr double kPlaneReach = 1e4;
constexpr int kLeastWatches = 256;  // of a thread

Bounds grown(const Bounds& bounds, double by) {
  return {bounds.low - Vec3::Constant(by), bounds.high + Vec3::Constant(by)};
}
Bounds joined(const Bounds& p, const Bounds& q) {
  return {p.low.cwiseMin(q.low), p.high.cwiseMax(q.high)};
}
bool within(const Bounds& inner, const Bounds& outer) {
  return (inner.low.array() >= outer.low.array()).all() &&
         (inner.high.array() <= outer.high.array()).all();
}
bool overlap(const Bounds& p, const Bounds& q) {
  return (p.low.array() <= q.high.array()).all() && (q.low.array() <= p.high.array()).all();
}

Bounds swept(const Solid& solid, const Pose& start, const Pose& end) {
  return joined(boundsAt(solid, start.x, start.q.toRotationMatrix()),
                boundsAt(solid, end.x, end.q.toRotationMatrix()));
}

// Not less than swept(), without the rotation at the end.
Bounds path(const Item& item) {
  const Bounds start = boundsAt(item.solid, item.x, item.R);
  const Vec3 size = Vec3::Constant(item.solid.size), turn = Vec3::Constant(item.turn);
  const Bounds turned{(start.low - turn).cwiseMax(item.x - size),
                      (start.high + turn).cwiseMin(item.x + size)};
  const Bounds way =
      joined(joined(start, turned), {turned.low + item.move, turned.high + item.move});
  return grown(way, item.push);
}

// Room for more steps like this one, and for a little more in all directions.
Bounds fattened(const Solid& solid, const Bounds& swept, const Vec3& move, double margin,
                double steps = kAhead) {
  const Bounds ahead{swept.low + steps * move, swept.high + steps * move};
  return grown(joined(swept, ahead), margin + kSlack * solid.size);
}

// Whether bounds reach below a plane (its body does not move within a step).
bool reaches(const Bounds& bounds, const Item& plane) {
  const Vec3 n = plane.R * plane.solid.normal;
  const Vec3 lowest = (n.array() > 0).select(bounds.low, bounds.high);
  return n.dot(lowest - plane.x) <= plane.solid.offset;
}

// Bits of a pair's key: for the place of each of its two items, and for the sides of the pair.
constexpr int kItemBits = 28, kSideBits = 8;

// Ordered as the items are: by body, then part.
std::uint64_t pairKey(int p, int q) {
  return static_cast<std::uint64_t>(p) << (kItemBits + kSideBits) | static_cast<std::uint64_t>(q)
                                                                        << kSideBits;
}

}  // namespace

bool isFirst(const Item& p, const Item& q) {
  if (p.solid.kind != q.solid.kind) return p.solid.kind < q.solid.kind;
  if (p.movable != q.movable) return p.movable;
  return p.body < q.body;
}

void Pairs::add(BodyId body, const Shape& shape, bool movable) {
  require(body >= 0 && body >= static_cast<BodyId>(indexOf_.size()),
          "collider: bodies must be added once, with increasing ids");
  indexOf_.resize(static_cast<std::size_t>(body) + 1, -1);
  indexOf_[body] = static_cast<int>(items_.size());
  const auto* compound = std::get_if<Compound>(&shape);
  if (compound == nullptr) return addItem(body, shape, movable);
  for (const Part& part : compound->parts->list) {
    addItem(body, part.shape, movable);
    items_.back().isPart = true;
    items_.back().inBody = part.pose;
  }
}

void Pairs::addItem(BodyId body, const Shape& shape, bool movable) {
  Item item;
  item.body = body;
  item.movable = movable;
  item.solid = makeSolid(shape);
  item.isPlane = item.solid.kind == SolidKind::plane;
  require(!movable || !item.isPlane, "collider: a plane must not be movable");
  if (item.isPlane) planes_.push_back(static_cast<int>(items_.size()));
  items_.push_back(std::move(item));
  told_.emplace_back();
  moving_.push_back(static_cast<int>(items_.size()) - 1);
  treeIndex_.push_back(-1);
  moved_.push_back(1);
  const double nowhere = std::numeric_limits<double>::infinity();
  fat_.push_back({Vec3::Constant(nowhere), Vec3::Constant(-nowhere)});
}

void Pairs::ignore(BodyId a, BodyId b) {
  const auto pair = std::minmax(a, b);
  const auto at =
      std::lower_bound(ignored_.begin(), ignored_.end(), std::pair<BodyId, BodyId>(pair));
  if (at != ignored_.end() && *at == std::pair<BodyId, BodyId>(pair)) return;
  ignored_.insert(at, pair);
  ignoredMore_ = true;
}

int Pairs::indexOf(BodyId body) const {
  return body >= 0 && body < static_cast<BodyId>(indexOf_.size()) ? indexOf_[body] : -1;
}

bool Pairs::wanted(const Item& p, const Item& q) const {
  if ((!p.movable && !q.movable) || p.body == q.body) return false;
  if (p.solid.kind == SolidKind::point && q.solid.kind == SolidKind::point) return false;
  const std::pair<BodyId, BodyId> pair(std::minmax(p.body, q.body));
  return !std::binary_search(ignored_.begin(), ignored_.end(), pair);
}

bool Pairs::touches(int p, int q) const {
  if (items_[p].isPlane) return reaches(fat_[q], items_[p]);
  if (items_[q].isPlane) return reaches(fat_[p], items_[q]);
  return overlap(fat_[p], fat_[q]);
}

// Findings for so many more: they are large, and come all at once. Nothing is allocated when pairs
// part.
void Pairs::makeRoom(std::size_t more) {
  const std::size_t all = findings_.size() + more - std::min(more, free_.size());
  if (all > findings_.capacity()) findings_.reserve(std::max(all, 2 * findings_.capacity()));
  free_.reserve(findings_.capacity());
  while (free_.size() < more) {
    free_.push_back(static_cast<int>(findings_.size()));
    findings_.emplace_back();
  }
}

Watch Pairs::newWatch(const std::pair<int, int>& items, int finding) {
  Watch watch;
  watch.a = items.first;
  watch.b = items.second;
  watch.finding = finding;
  name(watch, findings_[finding].manifold);
  return watch;
}

std::pair<int, int> Pairs::itemsOf(std::uint64_t key) {
  constexpr std::uint64_t kItem = (std::uint64_t{1} << kItemBits) - 1;
  return {static_cast<int>(key >> (kItemBits + kSideBits)),
          static_cast<int>(key >> kSideBits & kItem)};
}

void Pairs::name(const Watch& watch, Manifold& manifold) const {
  const Item &a = items_[watch.a], &b = items_[watch.b];
  manifold.a = a.body;
  manifold.b = b.body;
  manifold.radial = b.solid.kind <= SolidKind::sphere && !a.isPart && !b.isPart;
  manifold.carried = b.solid.kind >= SolidKind::box;
  manifold.pair = pairKey(watch.a, watch.b);
}

bool Pairs::isParted(const Watch& watch) const {
  const auto [p, q] = watch.items();
  if (!moved_[p] && !moved_[q] && !ignoredMore_) return false;
  return !touches(p, q) || (ignoredMore_ && !wanted(items_[p], items_[q]));
}

void Pairs::dropParted(Workers& workers) {
  parted_.resize(watches_.size());
  workers.forEachChunk(static_cast<int>(watches_.size()), kLeastWatches, [&](int from, int to) {
    for (int k = from; k < to; ++k) parted_[k] = isParted(watches_[k]);
  });
  watchedAt_.assign(items_.size() + 1, 0);
  others_.clear();
  for (std::size_t k = 0; k < watches_.size(); ++k) {
    if (parted_[k]) {
      free_.push_back(watches_[k].finding);
      continue;
    }
    if (others_.size() < k) watches_[others_.size()] = watches_[k];
    others_.push_back(watches_[k].b);
    ++watchedAt_[watches_[k].a + 1];
  }
  watches_.resize(others_.size());
  std::partial_sum(watchedAt_.begin(), watchedAt_.end(), watchedAt_.begin());
}

bool Pairs::isWatched(int p, int q) const {
  const auto from = others_.begin() + watchedAt_[p], to = others_.begin() + watchedAt_[p + 1];
  return std::find(from, to, q) != to;
}

void Pairs::offer(int p, int q, std::vector<std::pair<int, int>>& fresh) const {
  if (items_[p].rests && items_[q].rests) return;
  if (!isFirst(items_[p], items_[q])) std::swap(p, q);
  if (isWatched(p, q) || !touches(p, q) || !wanted(items_[p], items_[q])) return;
  fresh.emplace_back(p, q);
}

void Pairs::updateTree() {
  tree_.update(movedTree_, treeBounds_);
  ++broadPhaseCalls_;
}

// Each pair once, though it is found from both where both moved.
std::span<const int> Pairs::findNew(Workers& workers) {
  constexpr int kLeastItems = 16;  // of a thread
  const int moved = static_cast<int>(movedTree_.size());
  offers_.resize(std::max<std::size_t>(offers_.size(), moved / kLeastItems + 1));
  for (Offers& offers : offers_) offers.fresh.clear();
  workers.forEachChunk(moved, kLeastItems, [&](int from, int to) {
    Offers& own = offers_[from / kLeastItems];
    for (int k = from; k < to; ++k) {
      const int p = itemOfTree_[movedTree_[k]];
      own.found.clear();
      tree_.findAt(movedTree_[k], own.found);
      for (const int t : own.found) {
        const int q = itemOfTree_[t];
        if (!moved_[q] || p < q) offer(p, q, own.fresh);
      }
      for (const int plane : planes_) offer(p, plane, own.fresh);
    }
  });
  fresh_.clear();
  for (const Offers& offers : offers_) {
    fresh_.insert(fresh_.end(), offers.fresh.begin(), offers.fresh.end());
  }
  std::sort(fresh_.begin(), fresh_.end());
  mergeFresh(workers);
  ignoredMore_ = false;
  return freshAt_;
}

// Each takes its place among the others. Who has a part of these has what comes before each of
// them, and the last one what comes after all.
void Pairs::mergeFresh(Workers& workers) {
  const auto isBefore = [](const Watch& w, const std::pair<int, int>& p) { return w.items() < p; };
  const int old = static_cast<int>(watches_.size());
  freshAt_.resize(fresh_.size());
  if (fresh_.empty()) return;
  makeRoom(fresh_.size());
  const std::span<const int> findings = std::span(free_).last(fresh_.size());
  const std::size_t all = watches_.size() + fresh_.size();
  if (all > merged_.capacity()) merged_.reserve(2 * all);
  merged_.resize(all);
  const auto freshUntil = [&](int i) {
    if (i == old) return fresh_.end();
    return std::lower_bound(fresh_.begin(), fresh_.end(), watches_[i].items());
  };
  workers.forEachChunk(old + 1, kLeastWatches, [&](int from, int to) {
    auto next = watches_.begin() + from;
    const auto end = watches_.begin() + std::min(to, old);
    const auto last = freshUntil(to - 1);
    for (auto k = from == 0 ? fresh_.begin() : freshUntil(from - 1); k != last; ++k) {
      const auto behind = std::lower_bound(next, end, *k, isBefore);
      const auto i = k - fresh_.begin();
      const auto at = std::copy(next, behind, merged_.begin() + (next - watches_.begin()) + i);
      *at = newWatch(*k, findings[i]);
      freshAt_[i] = static_cast<int>(at - merged_.begin());
      next = behind;
    }
    std::copy(next, end, merged_.begin() + (next - watches_.begin()) + (last - fresh_.begin()));
  });
  free_.resize(free_.size() - fresh_.size());
  std::swap(watches_, merged_);
  merged_.reserve(watches_.capacity());
}

bool Pairs::takeMotion(int i, const Pose& bodyFrom, const Pose& bodyTo) {
  Item& item = items_[i];
  const Pose from = item.at(bodyFrom), to = item.at(bodyTo);
  const Mat3 R = from.q.toRotationMatrix();
  const bool planeMoved = item.isPlane && (R != item.R || from.x != item.x);
  const double reach = item.isPlane ? kPlaneReach : item.solid.size;
  item.travel += (from.x - item.x).norm() + reach * std::sqrt(0.5) * (R - item.R).norm();
  told_[i] = {from, to};
  setMotion(item, R, from, to);
  return planeMoved;
}

void Pairs::setMotion(Item& item, const Mat3& R, const Pose& from, const Pose& to) {
  item.R = R;
  item.x = from.x;
  item.move = to.x - from.x;
  item.turn = item.solid.coreRadius * 2 * (from.q.conjugate() * to.q).vec().norm();
}

void Pairs::toTree(int i) {
  if (treeIndex_[i] < 0) {
    treeIndex_[i] = static_cast<int>(itemOfTree_.size());
    itemOfTree_.push_back(i);
    treeBounds_.push_back(fat_[i]);
    tree_.add(fat_[i], items_[i].solid.kind == SolidKind::point);
  }
  treeBounds_[treeIndex_[i]] = fat_[i];
  movedTree_.push_back(treeIndex_[i]);
}

// f(item) of those whose motion is taken.
template <class F>
void Pairs::forEachTaken(Workers& workers, F&& f) const {
  constexpr int kLeastItems = 64;  // of a thread
  for (const std::vector<int>* list : {&moving_, &late_}) {
    workers.forEachChunk(static_cast<int>(list->size()), kLeastItems, [&](int from, int to) {
      for (int k = from; k < to; ++k) f((*list)[k]);
    });
  }
}

// True: a plane moved.
bool Pairs::takeMotions(std::span<const Pose> start, std::span<const Pose> end,
                        std::span<const double> push, Workers& workers) {
  std::atomic<bool> some = false;
  forEachTaken(workers, [&](int i) {
    Item& item = items_[i];
    item.push = push.empty() ? 0 : push[item.body];
    if (takeMotion(i, start[item.body], end[item.body])) some = true;
  });
  return some;
}

// True: they are others than before.
bool Pairs::takeBounds(int i, double margin, bool all) {
  const Item& item = items_[i];
  if (item.isPlane) return false;
  const Bounds bounds = path(item);
  if (!all && within(grown(bounds, margin), fat_[i])) return false;
  fat_[i] = fattened(item.solid, bounds, item.move, margin);
  return true;
}

bool Pairs::update(std::span<const Pose> start, std::span<const Pose> end, double margin,
                   std::span<const double> push, Workers& workers) {
  require(start.size() == end.size() && start.size() >= indexOf_.size(),
          "collider: start and end must hold a pose for each body");
  for (const int t : movedTree_) moved_[itemOfTree_[t]] = false;  // of the last time
  movedTree_.clear();
  const bool all = takeMotions(start, end, push, workers) || margin > margin_;
  if (all) {
    for (int i = 0; i < static_cast<int>(items_.size()); ++i)
      moved_[i] = takeBounds(i, margin, true);
  } else {
    forEachTaken(workers, [&](int i) { moved_[i] = takeBounds(i, margin, false); });
  }
  late_.clear();
  margin_ = std::max(margin, margin_);
  for (int i = 0; i < static_cast<int>(items_.size()); ++i) {
    if (moved_[i]) toTree(i);
  }
  freshAt_.clear();
  if (movedTree_.empty() && !ignoredMore_) return false;
  dropParted(workers);
  return true;
}

bool Pairs::outdated(std::span<const Pose> start, std::span<const Pose> end,
                     std::span<const BodyId> bodies) const {
  for (const BodyId body : bodies) {
    const int first = indexOf(body);
    for (int i = first; i < endOf(first); ++i) {
      if (items_[i].isPlane) continue;
      // Pairs are found within fat_, but what is told of them is of the motion that find() was
      // given.
      const Item& item = items_[i];
      const auto& [from, to] = told_[i];
      const Bounds told = fattened(item.solid, swept(item.solid, from, to), item.move, margin_, 1);
      const Bounds now = swept(item.solid, item.at(start[body]), item.at(end[body]));
      if (!within(now, told)) return true;
    }
  }
  return false;
}

}  // namespace physics::collision
