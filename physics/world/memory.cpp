// What a World holds, by the scene's word that calls for it.
#include "physics/world/impl.h"

namespace physics {
namespace {

template <class T>
std::size_t bytesOf(const std::vector<T>& list) {
  return list.capacity() * sizeof(T);
}
std::size_t bytesOf(const std::vector<bool>& list) { return list.capacity() / 8; }

std::size_t bytesOf(const Bodies& b) {
  return bytesOf(b.pose) + bytesOf(b.start) + bytesOf(b.velocity) + bytesOf(b.inverse) +
         bytesOf(b.inverseInertia) + bytesOf(b.inertia) + bytesOf(b.mass) + bytesOf(b.motion) +
         bytesOf(b.shift) + bytesOf(b.freeTurn) + bytesOf(b.shape) + bytesOf(b.friction) +
         bytesOf(b.restitution) + bytesOf(b.isSoft) + bytesOf(b.active);
}

std::size_t bytesOf(const SecondOrder& s) {
  return bytesOf(s.scheme) + bytesOf(s.step) + bytesOf(s.history) + bytesOf(s.origin) +
         bytesOf(s.before) + bytesOf(s.middle) + bytesOf(s.velocity) + bytesOf(s.angularMomentum) +
         bytesOf(s.target) + bytesOf(s.twist) + bytesOf(s.jointTwist) + bytesOf(s.kick);
}

std::size_t bytesOf(const Stepper& s) {
  return bytesOf(s.island) + bytesOf(s.allowed) + bytesOf(s.smooth) + bytesOf(s.parted) +
         bytesOf(s.unresolved) + bytesOf(s.bounded) + bytesOf(s.tried) + bytesOf(s.ratio);
}

std::size_t bytesOf(const Contacts& c) { return bytesOf(c.pairs) + bytesOf(c.previous); }

std::size_t bytesOf(const Sleep& s) {
  return bytesOf(s.still) + bytesOf(s.asleep) + bytesOf(s.island) + bytesOf(s.called) +
         bytesOf(s.contacts);
}

std::size_t bytesOf(const Local& l) {
  std::size_t sum = bytesOf(l.asked) + bytesOf(l.wanted) + bytesOf(l.substeps) + bytesOf(l.last) +
                    bytesOf(l.calm) + bytesOf(l.islands) + bytesOf(l.groups) + bytesOf(l.joins) +
                    bytesOf(l.start) + bytesOf(l.end);
  for (const Group& group : l.groups) {
    sum += bytesOf(group.bodies) + bytesOf(group.anisotropic) + bytesOf(group.contacts) +
           bytesOf(group.softContacts);
    for (const auto& items : group.items) sum += bytesOf(items);
  }
  return sum;
}

// The kinds of one word may be two, as springs are.
void addKinds(const Kinds& kinds, std::vector<EffectMemory>& memory) {
  forEachKind(kinds, [&](const auto& kind) {
    const auto& set = kind.set;
    const std::size_t bytes = bytesOf(set.items) + bytesOf(set.active) + bytesOf(set.lambda) +
                              bytesOf(set.kept) + bytesOf(set.tuned);
    const char* word = std::decay_t<decltype(kind)>::kWord;
    if (bytes == 0) return;
    if (!memory.empty() && memory.back().effect == word) {
      memory.back().bytes += bytes;
    } else {
      memory.push_back({word, bytes});
    }
  });
}

}  // namespace

std::vector<EffectMemory> World::memory() const {
  const Impl& w = *impl_;
  std::vector<EffectMemory> memory{{"bodies", bytesOf(w.bodies) + bytesOf(w.loads)}};
  addKinds(w.kinds, memory);
  const auto add = [&](const char* effect, std::size_t bytes) {
    if (bytes > 0) memory.push_back({effect, bytes});
  };
  add("gyroscopic", bytesOf(w.bodies.anisotropic));
  add("contact", w.collider.bytes() + bytesOf(w.contacts) + w.softCollider.bytes() +
                     bytesOf(w.softContacts) + w.small.bytes() + bytesOf(w.attached));
  add("restitution", bytesOf(w.velocityBefore));
  add("stepping", bytesOf(w.bodies.second) + bytesOf(w.stepper) + bytesOf(w.contactsBefore));
  add("direct", bytesOf(w.jointRows) + bytesOf(w.jointChange) + bytesOf(w.jointMotion));
  add("sleep", bytesOf(w.sleep) + bytesOf(w.activeMask) + bytesOf(w.own));
  add("local_substeps", bytesOf(w.local));
  return memory;
}

bool World::isAsleep(BodyId body) const {
  return impl_->sleep.count > 0 && impl_->sleep.asleep[body] != 0;
}

int World::substepsOf(BodyId body) const {
  if (impl_->settings.takesSmallSteps()) return impl_->small.substepsOf(body);
  const std::vector<int>& last = impl_->local.last;
  return last.empty() ? impl_->settings.substepCount() : last[body];
}

}  // namespace physics
