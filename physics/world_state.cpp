// A World as others see it: its constraints as values, and a state that was found elsewhere.
#include <cmath>

#include "physics/constraint_item.h"
#include "physics/effects/second_order.h"
#include "physics/world_impl.h"

namespace physics {
namespace {

bool isFinite(const Pose& pose, const Velocity& velocity) {
  return pose.x.allFinite() && pose.q.coeffs().allFinite() && pose.q.norm() > 1e-6 &&
         velocity.v.allFinite() && velocity.w.allFinite();
}

void forget(World::Impl& w) {
  w.contacts = {};
  w.softContacts.clear();
  w.loads.assign(w.loads.size(), Load{});
  forEachKind(w.kinds, [](auto& kind) {
    for (auto& lambda : kind.set.lambda) lambda = {};
  });
}

void findContactsHere(World::Impl& w) {
  if (!w.settings.contact) return;
  w.takeShapes();
  const auto& pose = w.bodies.pose;
  const double margin = w.settings.contact->margin;
  update(w.contacts, w.collider.find(pose, pose, margin), w.bodies);
  if (w.softCollider.empty()) return;
  startSoftContacts(w.softCollider.find(pose, pose, margin), w.softCollider, w.bodies,
                    w.softContacts);
}

}  // namespace

FreeFlight World::Impl::flight(double dt) const {
  FreeFlight flight{settings.gravity, loads, velocityBefore, {}, dt};
  flight.attached.assign(bodies.pose.size(), false);
  forEachKind(kinds, [&](const auto& kind) {
    for (const auto& item : kind.set.items) {
      for (const BodyId body : item.bodies) flight.attached[body] = true;
    }
  });
  for (const SoftContact& contact : softContacts) flight.attached[contact.body] = true;
  return flight;
}

bool World::setState(std::span<const Pose> poses, std::span<const Velocity> velocities) {
  Bodies& b = impl_->bodies;
  const auto count = static_cast<std::size_t>(b.size());
  require(poses.size() == count && velocities.size() == count,
          "a state needs a pose and a velocity for every body, the world body included");
  for (std::size_t i = 0; i < count; ++i) {
    if (!isFinite(poses[i], velocities[i])) return false;
  }
  for (BodyId i = kWorldBody + 1; i < b.size(); ++i) {
    b.pose[i] = poses[i];
    if (poses[i].q.squaredNorm() != 1) b.pose[i].q.normalize();
    b.velocity[i] = velocities[i];
    b.correction[i] = {};
    b.shift[i].setZero();
    b.freeTurn[i].setZero();
    forgetPast(b.second, i);
  }
  b.start = b.pose;
  refreshInertia(b);
  forget(*impl_);
  findContactsHere(*impl_);
  return true;
}

std::vector<ConstraintItem> World::constraints() const {
  std::vector<ConstraintItem> items;
  forEachKind(impl_->kinds, [&](const auto& kind) {
    for (const auto& item : kind.set.items) {
      items.push_back({std::decay_t<decltype(kind)>::kWord, item});
    }
  });
  return items;
}

std::vector<std::array<BodyId, 2>> World::ignoredPairs() const {
  std::vector<std::array<BodyId, 2>> pairs;
  for (const auto& [a, b] : impl_->collider.ignored()) pairs.push_back({a, b});
  return pairs;
}

}  // namespace physics
