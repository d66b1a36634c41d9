// Which bounds overlap: FCL's dynamic tree behind a plain interface.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/collision/solid.h"

namespace physics::collision {

class BroadPhase {
 public:
  BroadPhase();
  ~BroadPhase();
  BroadPhase(const BroadPhase&) = delete;
  BroadPhase& operator=(const BroadPhase&) = delete;

  // Items are numbered from 0 in the order they come. Two points (`small`) are never reported
  // together.
  void add(const Bounds& bounds, bool small);
  void clear();

  // Takes the new bounds of the items `moved` over.
  void update(std::span<const int> moved, std::span<const Bounds> bounds);

  void balance();  // after many were added
  // Append the items whose bounds overlap those of item i, without it; or `bounds`. In no order,
  // without allocating beyond `found`. Any thread may ask at any time.
  void findAt(int i, std::vector<int>& found) const;
  void find(const Bounds& bounds, std::vector<int>& found) const;

  std::size_t bytes() const;  // held now, the tree's nodes included

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace physics::collision
