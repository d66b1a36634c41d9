// Which bounds overlap: FCL's dynamic tree behind a plain interface.
#pragma once

#include <array>
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

  // Takes the new bounds of the items `moved` over, then appends each pair of a moved item and
  // another whose bounds overlap; in no order, a pair of two moved items twice. No allocation
  // beyond `found`.
  void update(std::span<const int> moved, std::span<const Bounds> bounds,
              std::vector<std::array<int, 2>>& found);

  void balance();  // after many were added
  // Appends the items whose bounds overlap `bounds`, in no order. Any thread may ask at any time.
  void find(const Bounds& bounds, std::vector<int>& found) const;

  std::size_t bytes() const;  // held now, the tree's nodes included

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace physics::collision
