// The pairs of bodies near enough to be watched, found by fat bounds and kept in order.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "physics/collision/broad_phase.h"
#include "physics/collision/collider.h"
#include "physics/collision/solid.h"

namespace physics::collision {

// A body as the collider knows it, with its motion in the present step. What is read for most pairs
// comes first, in a line of the cache.
struct alignas(64) Item {
  double travel = 0;  // length of the way of its points so far, at most [m]
  double turn = 0;    // the furthest that turning moves a point of the core in this step [m]
  Vec3 move = Vec3::Zero();
  BodyId body = 0;
  bool movable = false;
  bool rests = false;  // stands still until it is woken
  bool isPlane = false;
  Vec3 x = Vec3::Zero();  // at the start
  Mat3 R = Mat3::Identity();
  Solid solid;
};

// Two items, and what is known of them since their last narrow phase. Plain numbers: watches are
// moved as bytes when pairs come and go.
struct Watch {
  int a = 0, b = 0;
  int finding = 0;         // what was found is kept there
  std::uint8_t count = 0;  // of the points found then
  bool known = false;
  bool isNew = false;         // it was the last look
  std::uint8_t calls = 0;     // narrow-phase evaluations of the last look
  double travel = 0;          // of both items together, then
  double distance = 0;        // then, or a lower bound
  double reach = 0;           // how far was looked
  std::array<double, 3> n{};  // b's frame: without points, they are `distance` apart along it

  Vec3 normal() const { return {n[0], n[1], n[2]}; }
  void setNormal(const Vec3& normal) { n = {normal.x(), normal.y(), normal.z()}; }
  std::pair<int, int> items() const { return {a, b}; }
};
static_assert(std::is_trivially_copyable_v<Watch>);
struct Finding {
  Relative pose;
  Manifold manifold;
};

class Pairs {
 public:
  void add(BodyId body, const Shape& shape, bool movable);
  void ignore(BodyId a, BodyId b);
  const std::vector<std::pair<BodyId, BodyId>>& ignored() const { return ignored_; }

  // Takes the motion of all items over and brings the list up to date: afterwards it holds every
  // pair whose surfaces come within `margin` of each other between start and end.
  void update(std::span<const Pose> start, std::span<const Pose> end, double margin);
  bool outdated(std::span<const Pose> start, std::span<const Pose> end,
                std::span<const BodyId> bodies) const;

  // Items that stand still leave the list of moving ones, and their pairs that of watched ones.
  void rest(std::span<const BodyId> bodies, std::span<const Pose> poses);
  void wake(std::span<const BodyId> bodies);

  bool canTouch() const;  // some pair is wanted
  std::size_t bytes() const;

  const std::vector<Item>& items() const { return items_; }
  int indexOf(BodyId body) const;  // -1: no shape

  std::vector<Watch>& watches() { return watches_; }  // sorted by (a, b)
  const std::vector<Watch>& watches() const { return watches_; }
  Finding& finding(const Watch& watch) { return findings_[watch.finding]; }
  std::int64_t broadPhaseCalls() const { return broadPhaseCalls_; }

 private:
  bool takeMotion(int item, const Pose& from, const Pose& to);  // true: a plane moved
  void fatten(int item, const Bounds& bounds, double margin);
  bool takeMotions(std::span<const Pose> start, std::span<const Pose> end, bool all);
  void takeBounds(int item, double margin, bool all);
  bool bothRest(const Watch& watch) const { return items_[watch.a].rests && items_[watch.b].rests; }
  bool wanted(const Item& p, const Item& q) const;
  bool touches(int p, int q) const;  // of the fat bounds
  void dropParted();
  void offer(int p, int q);
  void findNew();
  void mergeFresh();
  Watch newWatch(int p, int q);

  std::vector<Item> items_;
  std::vector<std::pair<Pose, Pose>> told_;  // by item: the motion that find() was given
  std::vector<Bounds> fat_;
  std::vector<int> indexOf_;  // by BodyId
  std::vector<int> planes_;   // items that are planes; the tree does not know them
  std::vector<int> moving_;   // items that do not rest
  std::vector<int> late_;     // items that rest, to be placed once more
  std::vector<int> treeIndex_, itemOfTree_;
  BroadPhase tree_;
  std::vector<std::pair<BodyId, BodyId>> ignored_;  // sorted, first < second
  bool ignoredMore_ = false;
  double margin_ = -1;  // of the fat bounds
  std::int64_t broadPhaseCalls_ = 0;

  std::vector<Watch> watches_;
  std::vector<Watch> parked_;      // of two that rest; sorted
  std::vector<Finding> findings_;  // beside the watches: seldom read while at rest
  std::vector<int> free_;          // of the findings
  std::vector<std::pair<int, int>> fresh_;
  std::vector<char> moved_;  // by item
  std::vector<int> movedTree_;
  std::vector<Bounds> treeBounds_;
  std::vector<std::array<int, 2>> found_;
};

// The way the bodies of a pair are ordered: by kind, then static last, then by id.
bool isFirst(const Item& p, const Item& q);

}  // namespace physics::collision
