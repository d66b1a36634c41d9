// Islands: bodies that constraints and contacts join, directly or through others. What is static
// joins nothing.
#pragma once

#include <span>
#include <vector>

#include "physics/world.h"

namespace physics {

// By body: the first body of its island.
using Islands = std::vector<BodyId>;

bool isMovable(const Bodies& bodies, BodyId body);

// By constraints alone; worked out once.
const Islands& jointIslands(World::Impl& world);

void join(const Bodies& bodies, Islands& islands, BodyId a, BodyId b);

// Joins those that a contact has moved in this substep.
void joinPushed(const World::Impl& world, Islands& islands);

// After the joins: every entry of `bodies` is its island's first body.
void settle(Islands& islands, std::span<const BodyId> bodies);

}  // namespace physics
