// The pairs of bodies near enough to be watched, found by fat bounds and kept in order.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "physics/base/archive.h"
#include "physics/base/workers.h"
#include "physics/collision/broad_phase.h"
#include "physics/collision/watch.h"

namespace physics::collision {

class Pairs {
 public:
  void add(BodyId body, const Shape& shape, bool movable);
  void ignore(BodyId a, BodyId b);
  const std::vector<std::pair<BodyId, BodyId>>& ignored() const { return ignored_; }

  // Takes the motion of all items over, and drops pairs that parted. `push` [m], by BodyId or
  // empty: how much further hits may take a body. False: there are no others, either.
  bool update(std::span<const Pose> start, std::span<const Pose> end, double margin,
              std::span<const double> push, Workers& workers);
  // Then the tree of bounds, while pairs that stay may be looked at.
  void updateTree();
  // Then the others: the list holds every pair whose surfaces come within `margin` of each other
  // between start and end. Returned: the places of those that are new.
  std::span<const int> findNew(Workers& workers);
  bool outdated(std::span<const Pose> start, std::span<const Pose> end,
                std::span<const BodyId> bodies) const;

  // Items that stand still leave the list of moving ones, and their pairs that of watched ones.
  void rest(std::span<const BodyId> bodies, std::span<const Pose> poses);
  void wake(std::span<const BodyId> bodies);

  bool canTouch() const;  // some pair is wanted
  void archive(Archive& a);
  std::size_t bytes() const;

  const std::vector<Item>& items() const { return items_; }
  int indexOf(BodyId body) const;  // its first; -1: no shape
  int endOf(int first) const {     // the items of a body follow each other
    int end = first;
    while (end >= 0 && end < std::ssize(items_) && items_[end].body == items_[first].body) ++end;
    return end;
  }

  static std::pair<int, int> itemsOf(std::uint64_t key);  // of a manifold's pair
  void name(const Watch& watch, Manifold& manifold) const;

  std::vector<Watch>& watches() { return watches_; }  // sorted by (a, b)
  const std::vector<Watch>& watches() const { return watches_; }
  Finding& finding(const Watch& watch) { return findings_[watch.finding]; }
  std::int64_t broadPhaseCalls() const { return broadPhaseCalls_; }

 private:
  void addItem(BodyId body, const Shape& shape, bool movable);
  bool takeMotion(int item, const Pose& from, const Pose& to);  // true: a plane moved
  void toTree(int item);
  template <class F>
  void forEachTaken(Workers& workers, F&& f) const;
  bool takeMotions(std::span<const Pose> start, std::span<const Pose> end,
                   std::span<const double> push, Workers& workers);
  bool takeBounds(int item, double margin, bool all);
  bool bothRest(const Watch& watch) const { return items_[watch.a].rests && items_[watch.b].rests; }
  bool wanted(const Item& p, const Item& q) const;
  bool touches(int p, int q) const;  // of the fat bounds
  bool isParted(const Watch& watch) const;
  void dropParted(Workers& workers);
  bool isWatched(int p, int q) const;
  void offer(int p, int q, std::vector<std::pair<int, int>>& fresh) const;
  void mergeFresh(Workers& workers);
  void makeRoom(std::size_t more);
  Watch newWatch(const std::pair<int, int>& items, int finding);
  void archiveFinding(Archive& a, const Watch& watch);
  static void setMotion(Item& item, const Mat3& R, const Pose& from, const Pose& to);

  std::vector<Item> items_;
  std::vector<std::pair<Pose, Pose>> told_;  // by item: the motion that find() was given
  std::vector<Bounds> fat_;
  std::vector<int> indexOf_;  // by BodyId, its first item
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
  std::vector<Watch> merged_;            // the next watches
  std::vector<Watch> parked_;            // of two that rest; sorted
  std::vector<Finding> findings_;        // beside the watches: seldom read while at rest
  std::vector<int> free_;                // of the findings
  std::vector<char> parted_;             // scratch, by watch
  std::vector<int> watchedAt_, others_;  // of the watches: by a, where its own begin; and their b
  std::vector<std::pair<int, int>> fresh_;
  std::vector<int> freshAt_;  // where these are
  std::vector<char> moved_;   // by item
  std::vector<int> movedTree_;
  std::vector<Bounds> treeBounds_;
  struct Offers {  // of some that moved, by one thread
    std::vector<int> found;
    std::vector<std::pair<int, int>> fresh;
  };
  std::vector<Offers> offers_;
};

// The way the bodies of a pair are ordered: by kind, then static last, then by id.
bool isFirst(const Item& p, const Item& q);

}  // namespace physics::collision
