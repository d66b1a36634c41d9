// All that the next step depends on, as bytes.
#include "physics/state/archive.h"

#include "physics/effects/sleep.h"
#include "physics/world/impl.h"

namespace physics {
namespace {

// To be raised where a list of members changes.
constexpr int kVersion = 12;

// Scratch, and what settings and definitions say, is left out; so are the start of a step that may
// be made anew, and the poses before it: each step keeps them first.
void archiveAll(Archive& a, WorldState& w) {
  a.expect(kVersion, "it was kept by another version");
  a.expect(w.bodies.size(), "bodies");
  a.expect(w.arms.size(), "arms");
  bool hasShapes = w.hasShapes;
  a(hasShapes);
  if (hasShapes) w.takeShapes();
  a(w.bodies, w.stepCount, w.substep, w.ahead, w.loads, w.loaded, w.last.replaced, w.sleep);
  if (a.reads()) {
    w.last.pose = w.bodies.pose;
    w.last.velocity = w.bodies.velocity;
    listAwake(w);
  }
  a(w.kinds, w.collider, w.contacts.pairs, w.softContacts, w.arms, w.stepper, w.local);
  w.small.archive(a, w);
}

}  // namespace

std::string World::saved() const {
  std::string bytes;
  Archive archive(bytes);
  archiveAll(archive, *impl_);
  return bytes;
}

void World::restore(std::string_view bytes) {
  Archive archive(bytes);
  archiveAll(archive, *impl_);
  require(archive.isAtEnd(), "the state holds more than this world");
}

}  // namespace physics
