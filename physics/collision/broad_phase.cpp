// The only file that includes FCL: its dynamic AABB tree, fed with boxes that are never rotated.
#include "physics/collision/broad_phase.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision_object.h>

#include <cstdint>

namespace physics::collision {

struct BroadPhase::Impl {
  struct Item {
    std::shared_ptr<fcl::Boxd> box;
    std::unique_ptr<fcl::CollisionObjectd> object;
    bool small = false;
  };
  std::vector<Item> items;
  fcl::DynamicAABBTreeCollisionManagerd large, small;
  std::vector<fcl::CollisionObjectd*> movedLarge, movedSmall;
  static constexpr double kFurthest = 1e90;  // m

  // FCL multiplies sides, and chooses between volumes: beyond kFurthest it would choose none.
  void place(Item& item, const Bounds& bounds) const {
    const Vec3 low = bounds.low.cwiseMax(-kFurthest).cwiseMin(kFurthest);
    const Vec3 high = bounds.high.cwiseMax(-kFurthest).cwiseMin(kFurthest);
    item.box->side = high - low;
    item.box->computeLocalAABB();
    item.object->setTranslation(0.5 * (low + high));
    item.object->computeAABB();
  }
};

namespace {

bool append(fcl::CollisionObjectd* p, fcl::CollisionObjectd* q, void* data) {
  const auto number = [](const fcl::CollisionObjectd* object) {
    return static_cast<int>(reinterpret_cast<std::intptr_t>(object->getUserData()));
  };
  if (p != q) {
    static_cast<std::vector<std::array<int, 2>>*>(data)->push_back({number(p), number(q)});
  }
  return false;
}

}  // namespace

BroadPhase::BroadPhase() : impl_(std::make_unique<Impl>()) {}
BroadPhase::~BroadPhase() = default;

void BroadPhase::add(const Bounds& bounds, bool small) {
  Impl::Item item;
  item.small = small;
  item.box = std::make_shared<fcl::Boxd>(1, 1, 1);
  item.object = std::make_unique<fcl::CollisionObjectd>(item.box);
  item.object->setUserData(
      reinterpret_cast<void*>(static_cast<std::intptr_t>(impl_->items.size())));
  impl_->place(item, bounds);
  (small ? impl_->small : impl_->large).registerObject(item.object.get());
  impl_->items.push_back(std::move(item));
}

std::size_t BroadPhase::bytes() const {
  using Node = fcl::detail::NodeBase<fcl::AABBd>;  // a binary tree has two for each leaf
  const std::size_t each = sizeof(Impl::Item) + sizeof(fcl::Boxd) + sizeof(fcl::CollisionObjectd);
  return sizeof(Impl) + impl_->items.size() * (each + 2 * sizeof(Node)) +
         (impl_->movedLarge.capacity() + impl_->movedSmall.capacity()) * sizeof(void*);
}

void BroadPhase::update(std::span<const int> moved, std::span<const Bounds> bounds,
                        std::vector<std::array<int, 2>>& found) {
  impl_->movedLarge.clear();
  impl_->movedSmall.clear();
  for (const int i : moved) {
    Impl::Item& item = impl_->items[i];
    impl_->place(item, bounds[i]);
    (item.small ? impl_->movedSmall : impl_->movedLarge).push_back(item.object.get());
  }
  if (!impl_->movedLarge.empty()) impl_->large.update(impl_->movedLarge);
  if (!impl_->movedSmall.empty()) impl_->small.update(impl_->movedSmall);
  for (const int i : moved) {
    const Impl::Item& item = impl_->items[i];
    impl_->large.collide(item.object.get(), &found, append);
    if (!item.small) impl_->small.collide(item.object.get(), &found, append);
  }
}

}  // namespace physics::collision
