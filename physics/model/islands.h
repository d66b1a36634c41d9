// Islands: bodies that constraints and contacts join, directly or through others. What is static
// joins nothing.
#pragma once

#include <span>
#include <vector>

#include "physics/constraints/contact.h"

namespace physics {

// By body: the first body of its island.
using Islands = std::vector<BodyId>;

inline bool isMovable(const Bodies& bodies, BodyId body) {
  return bodies.motion[body] != Motion::kStatic;
}

// Of two that touch, the first, or the second where the first is static: islands are told by what
// moves.
inline BodyId moverOf(const Bodies& bodies, BodyId a, BodyId b) {
  return isMovable(bodies, a) ? a : b;
}

void join(const Bodies& bodies, Islands& islands, BodyId a, BodyId b);

// Joins those that a contact has moved in this substep.
void joinPushed(const Contacts& contacts, const Bodies& bodies, Islands& islands);

// After the joins: every entry of `bodies` is its island's first body; or of all.
void settle(Islands& islands, std::span<const BodyId> bodies);
void settleAll(Islands& islands);

}  // namespace physics
