// The only file that includes FCL: its dynamic tree of bounds.
#include "physics/collision/broad_phase.h"

#include <fcl/broadphase/detail/hierarchy_tree.h>
#include <fcl/math/bv/AABB.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>

namespace physics::collision {
namespace {

using Tree = fcl::detail::HierarchyTree<fcl::AABBd>;
using Node = fcl::detail::NodeBase<fcl::AABBd>;

// FCL multiplies sides, and chooses between volumes: beyond this it would choose none.
constexpr double kFurthest = 1e90;  // m

fcl::AABBd boxOf(const Bounds& bounds) {
  fcl::AABBd box;
  box.min_ = bounds.low.cwiseMax(-kFurthest).cwiseMin(kFurthest);
  box.max_ = bounds.high.cwiseMax(-kFurthest).cwiseMin(kFurthest);
  return box;
}

bool overlap(const fcl::AABBd& p, const fcl::AABBd& q) {
  bool apart = false;
  for (int k = 0; k < 3; ++k) apart |= p.min_[k] > q.max_[k] || q.min_[k] > p.max_[k];
  return !apart;
}

// Below a node, but for the leaf `self`. How deep that went.
int collect(const Node* node, const fcl::AABBd& box, const Node* self, std::vector<int>& found) {
  int depth = 0, deepest = 0;
  for (; overlap(node->bv, box); node = node->children[1], ++depth) {
    if (node->children[1] == nullptr) {
      if (node != self) {
        found.push_back(static_cast<int>(reinterpret_cast<std::intptr_t>(node->data)));
      }
      break;
    }
    deepest = std::max(deepest, depth + 1 + collect(node->children[0], box, self, found));
  }
  return std::max(deepest, depth);
}

}  // namespace

struct BroadPhase::Impl {
  struct Item {
    Node* leaf = nullptr;
    bool small = false;
  };
  struct Part {
    Tree tree;
    std::atomic<int> deepest = 0;  // that the last walks went

    // A little of it each time; all of it where it got deep. As FCL's manager does.
    void balance() {
      if (deepest > static_cast<int>(std::bit_width(tree.size())) + 10) {
        tree.balanceTopdown();
      } else {
        tree.balanceIncremental(10);
      }
      deepest = 0;
    }

    void find(const fcl::AABBd& box, const Node* self, std::vector<int>& found) {
      if (tree.empty()) return;
      const int depth = collect(tree.getRoot(), box, self, found);
      int most = deepest.load(std::memory_order_relaxed);
      while (depth > most && !deepest.compare_exchange_weak(most, depth)) {
      }
    }
  };
  std::vector<Item> items;
  Part large, small;

  Part& partOf(const Item& item) { return item.small ? small : large; }
};

BroadPhase::BroadPhase() { clear(); }
void BroadPhase::clear() { impl_ = std::make_unique<Impl>(); }
BroadPhase::~BroadPhase() = default;

void BroadPhase::add(const Bounds& bounds, bool small) {
  Impl::Item item{nullptr, small};
  const auto number = static_cast<std::intptr_t>(impl_->items.size());
  item.leaf = impl_->partOf(item).tree.insert(boxOf(bounds), reinterpret_cast<void*>(number));
  impl_->items.push_back(item);
}

std::size_t BroadPhase::bytes() const {  // a binary tree has two nodes for each leaf
  return sizeof(Impl) + impl_->items.size() * (sizeof(Impl::Item) + 2 * sizeof(Node));
}

void BroadPhase::update(std::span<const int> moved, std::span<const Bounds> bounds) {
  for (const int i : moved) {
    const Impl::Item& item = impl_->items[i];
    Impl::Part& part = impl_->partOf(item);
    const fcl::AABBd box = boxOf(bounds[i]);
    if (!item.leaf->bv.equal(box)) part.tree.update(item.leaf, box);
  }
  for (Impl::Part* part : {&impl_->large, &impl_->small}) part->balance();
}

void BroadPhase::findAt(int i, std::vector<int>& found) const {
  const Impl::Item& item = impl_->items[i];
  impl_->large.find(item.leaf->bv, item.leaf, found);
  if (!item.small) impl_->small.find(item.leaf->bv, item.leaf, found);
}

void BroadPhase::balance() {
  for (Impl::Part* part : {&impl_->large, &impl_->small}) part->tree.balanceTopdown();
}

void BroadPhase::find(const Bounds& bounds, std::vector<int>& found) const {
  const fcl::AABBd box = boxOf(bounds);
  for (Impl::Part* part : {&impl_->large, &impl_->small}) part->find(box, nullptr, found);
}

}  // namespace physics::collision
