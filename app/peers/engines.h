// What each engine's file offers to peers.cpp. An engine that is not there offers nothing.
#pragma once

#include <functional>
#include <optional>

#include "app/peers/peer.h"

namespace app {

struct PeerEntry {
  PeerMethod method;
  std::function<PeerStart(const physics::World&, int iterations)> start;
};

struct PeerOffer {
  PeerEngine engine;
  std::vector<PeerEntry> entries;
};

PeerOffer bulletOffer();
PeerOffer odeOffer();
PeerOffer mujocoOffer();

}  // namespace app
