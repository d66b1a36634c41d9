// A World as others see it: its constraints as values, and a state that was found elsewhere.
#include <cmath>

#include "physics/constraints/constraint_item.h"
#include "physics/effects/sleep.h"
#include "physics/motion/second_order.h"
#include "physics/world/impl.h"
#include "physics/world/state.h"

namespace physics {
namespace {

bool isFinite(const Pose& pose, const Velocity& velocity) {
  return pose.x.allFinite() && pose.q.coeffs().allFinite() && pose.q.norm() > 1e-6 &&
         velocity.v.allFinite() && velocity.w.allFinite();
}

// As far as normalising makes one: then the state comes back bit for bit.
bool isUnit(const Quat& q) { return std::abs(q.squaredNorm() - 1) < 1e-14; }

void forget(WorldState& w) {
  w.contacts = {};
  w.small.forget();
  w.softContacts.clear();
  w.loads.assign(w.loads.size(), Load{});
  w.loaded.clear();
  forEachKind(w.kinds, [](auto& kind) {
    for (auto& lambda : kind.set.lambda) lambda = {};
  });
}

// Bodies that rest in the collider may have been moved as well.
void takeStaticPoses(WorldState& w) {
  if (!w.touches) return;
  std::vector<BodyId> still;
  for (BodyId i = kWorldBody + 1; i < w.bodies.size(); ++i) {
    if (!isMovable(w.bodies, i)) still.push_back(i);
  }
  w.collider.wake(still);
  w.collider.rest(still, w.bodies.pose);
}

void wakeAll(WorldState& w) {
  for (BodyId i = kWorldBody + 1; i < w.bodies.size(); ++i) callAwake(w.sleep, i);
  wakeCalled(w);
}

void findContactsHere(WorldState& w) {
  if (!w.settings.contact) return;
  w.takeShapes();
  takeStaticPoses(w);
  const auto& pose = w.bodies.pose;
  const double margin = w.settings.contact->margin;
  if (w.touches) {
    w.collider.forgetFound();
    const auto found = w.collider.find(pose, pose, margin);
    if (w.settings.takesSmallSteps()) {
      w.small.contacts().clear();
      std::vector<KeptContact> none;
      keep(w.collider.found(), w.bodies, w.workers, w.small.contacts(), none);
    } else {
      update(w.contacts, found, w.bodies);
    }
  }
  if (w.softCollider.empty()) return;
  startSoftContacts(w.softCollider.find(pose, pose, margin), w.softCollider, w.bodies,
                    w.softContacts);
}

}  // namespace

BodyId firstNotFinite(std::span<const Pose> poses, std::span<const Velocity> velocities) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!isFinite(poses[i], velocities[i])) return static_cast<BodyId>(i);
  }
  return -1;
}

bool World::setState(std::span<const Pose> poses, std::span<const Velocity> velocities) {
  Bodies& b = impl_->bodies;
  const auto count = static_cast<std::size_t>(b.size());
  require(poses.size() == count && velocities.size() == count,
          "a state needs a pose and a velocity for every body, the world body included");
  if (firstNotFinite(poses, velocities) >= 0) return false;
  wakeAll(*impl_);
  for (BodyId i = kWorldBody + 1; i < b.size(); ++i) {
    b.pose[i] = poses[i];
    if (!isUnit(poses[i].q)) b.pose[i].q.normalize();
    b.velocity[i] = velocities[i];
    b.shift[i].setZero();
    b.freeTurn[i].setZero();
    forgetPast(b.second, i);
  }
  b.start = impl_->ahead = impl_->last.pose = b.pose;
  if (!b.second.empty()) b.second.origin = b.second.before = b.pose;
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
