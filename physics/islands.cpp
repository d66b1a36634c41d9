// Islands by union and find; the smaller id is the root, so that the order of joins does not
// matter.
#include "physics/islands.h"

#include <algorithm>
#include <numeric>

#include "physics/constraint_response.h"
#include "physics/world_impl.h"

namespace physics {
namespace {

BodyId rootOf(Islands& islands, BodyId body) {
  while (islands[body] != body) body = islands[body] = islands[islands[body]];
  return body;
}

}  // namespace

bool isMovable(const Bodies& bodies, BodyId body) { return bodies.motion[body] != Motion::kStatic; }

void join(const Bodies& bodies, Islands& islands, BodyId a, BodyId b) {
  if (!isMovable(bodies, a) || !isMovable(bodies, b)) return;
  const BodyId i = rootOf(islands, a), j = rootOf(islands, b);
  islands[std::max(i, j)] = std::min(i, j);
}

const Islands& jointIslands(World::Impl& w) {
  Islands& joined = w.joined;
  if (!joined.empty()) return joined;
  joined.resize(w.bodies.pose.size());
  std::iota(joined.begin(), joined.end(), 0);
  forEachKind(w.kinds, [&](const auto& kind) {
    for (const auto& item : kind.set.items) {
      const BodyId mover = moverOf(item, w.bodies);
      for (const BodyId body : item.bodies) join(w.bodies, joined, mover, body);
    }
  });
  for (BodyId i = 0; i < w.bodies.size(); ++i) joined[i] = rootOf(joined, i);
  return joined;
}

void joinPushed(const World::Impl& w, Islands& islands) {
  forEachPush(w.contacts,
              [&](const ContactPair& pair) { join(w.bodies, islands, pair.a, pair.b); });
}

void settle(Islands& islands, std::span<const BodyId> bodies) {
  for (const BodyId i : bodies) islands[i] = rootOf(islands, i);
}

}  // namespace physics
