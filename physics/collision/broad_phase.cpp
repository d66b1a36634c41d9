// The only file that includes FCL: its dynamic tree of bounds.
#include "physics/collision/broad_phase.h"

#include <fcl/broadphase/detail/hierarchy_tree.h>
#include <fcl/math/bv/AABB.h>

#include <algorithm>
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

void collect(const Node* node, const fcl::AABBd& box, std::vector<int>& found) {
  for (; overlap(node->bv, box); node = node->children[1]) {
    if (node->children[1] == nullptr) {
      return found.push_back(static_cast<int>(reinterpret_cast<std::intptr_t>(node->data)));
    }
    collect(node->children[0], box, found);
  }
}

}  // namespace

struct BroadPhase::Impl {
  struct Item {
    Node* leaf = nullptr;
    bool small = false;
  };
  struct Part {
    Tree tree;
    std::vector<const Node*> open;
    std::size_t deepest = 0;  // of the last walks: how many nodes were left open

    // A little of it each time; all of it where it got deep. As FCL's manager does.
    void balance() {
      const auto least = static_cast<std::size_t>(std::bit_width(tree.size()));
      if (deepest > least + 10) {
        tree.balanceTopdown();
      } else {
        tree.balanceIncremental(10);
      }
      deepest = 0;
    }
  };
  std::vector<Item> items;
  Part large, small;

  Part& partOf(const Item& item) { return item.small ? small : large; }

  void appendOverlaps(Part& part, int i, std::vector<std::array<int, 2>>& found) const {
    if (part.tree.empty()) return;
    const Node* self = items[i].leaf;
    const fcl::AABBd box = self->bv;
    part.open.assign(1, part.tree.getRoot());
    while (!part.open.empty()) {
      const Node* node = part.open.back();
      part.open.pop_back();
      if (!overlap(node->bv, box)) continue;
      if (node->children[1] != nullptr) {
        part.deepest = std::max(part.deepest, part.open.size());
        part.open.push_back(node->children[0]);
        part.open.push_back(node->children[1]);
      } else if (node != self) {
        found.push_back({i, static_cast<int>(reinterpret_cast<std::intptr_t>(node->data))});
      }
    }
  }
};

BroadPhase::BroadPhase() : impl_(std::make_unique<Impl>()) {}
BroadPhase::~BroadPhase() = default;

void BroadPhase::add(const Bounds& bounds, bool small) {
  Impl::Item item{nullptr, small};
  const auto number = static_cast<std::intptr_t>(impl_->items.size());
  item.leaf = impl_->partOf(item).tree.insert(boxOf(bounds), reinterpret_cast<void*>(number));
  impl_->items.push_back(item);
}

std::size_t BroadPhase::bytes() const {  // a binary tree has two nodes for each leaf
  return sizeof(Impl) + impl_->items.size() * (sizeof(Impl::Item) + 2 * sizeof(Node)) +
         (impl_->large.open.capacity() + impl_->small.open.capacity()) * sizeof(void*);
}

void BroadPhase::update(std::span<const int> moved, std::span<const Bounds> bounds,
                        std::vector<std::array<int, 2>>& found) {
  for (const int i : moved) {
    const Impl::Item& item = impl_->items[i];
    Impl::Part& part = impl_->partOf(item);
    const fcl::AABBd box = boxOf(bounds[i]);
    if (!item.leaf->bv.equal(box)) part.tree.update(item.leaf, box);
  }
  for (Impl::Part* part : {&impl_->large, &impl_->small}) part->balance();
  for (const int i : moved) {
    const Impl::Item& item = impl_->items[i];
    impl_->appendOverlaps(impl_->large, i, found);
    if (!item.small) impl_->appendOverlaps(impl_->small, i, found);
  }
}

void BroadPhase::balance() {
  for (Impl::Part* part : {&impl_->large, &impl_->small}) part->tree.balanceTopdown();
}

void BroadPhase::find(const Bounds& bounds, std::vector<int>& found) const {
  const fcl::AABBd box = boxOf(bounds);
  for (const Impl::Part* part : {&impl_->large, &impl_->small}) {
    if (!part->tree.empty()) collect(part->tree.getRoot(), box, found);
  }
}

}  // namespace physics::collision
