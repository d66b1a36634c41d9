// Bullet's articulated bodies, for bullet.cpp.
#pragma once

#include "app/peers/peer.h"

namespace app {

template <bool isRungeKutta>
PeerStart startMultibody(const physics::World& world, int iterations);

}  // namespace app
