// Islands by union and find; the smaller id is the root, so that the order of joins does not
// matter.
#include "physics/model/islands.h"

#include <algorithm>

namespace physics {
namespace {

BodyId rootOf(Islands& islands, BodyId body) {
  while (islands[body] != body) body = islands[body] = islands[islands[body]];
  return body;
}

}  // namespace

void join(const Bodies& bodies, Islands& islands, BodyId a, BodyId b) {
  if (!isMovable(bodies, a) || !isMovable(bodies, b)) return;
  const BodyId i = rootOf(islands, a), j = rootOf(islands, b);
  islands[std::max(i, j)] = std::min(i, j);
}

void joinPushed(const Contacts& contacts, const Bodies& bodies, Islands& islands) {
  for (const ContactPair& pair : contacts.pairs) {
    if (isLoaded(pair)) join(bodies, islands, pair.a, pair.b);
  }
}

void settle(Islands& islands, std::span<const BodyId> bodies) {
  for (const BodyId i : bodies) islands[i] = rootOf(islands, i);
}

void settleAll(Islands& islands) {
  for (BodyId i = 0; i < static_cast<BodyId>(islands.size()); ++i) islands[i] = rootOf(islands, i);
}

}  // namespace physics
