// The peers that were found when this was built.
#include "app/peers/engines.h"
#include "app/peers/peer.h"

namespace app {
namespace {

const std::vector<PeerOffer>& offers() {
  static const std::vector<PeerOffer> kOffers{bulletOffer(), odeOffer(), mujocoOffer()};
  return kOffers;
}

}  // namespace

std::vector<PeerEngine> peerEngines() {
  std::vector<PeerEngine> engines;
  for (const PeerOffer& offer : offers()) engines.push_back(offer.engine);
  return engines;
}

std::vector<PeerMethod> peerMethods() {
  std::vector<PeerMethod> methods;
  for (const PeerOffer& offer : offers()) {
    for (const PeerEntry& entry : offer.entries) methods.push_back(entry.method);
  }
  return methods;
}

PeerStart startPeer(const std::string& method, const physics::World& world, int iterations) {
  physics::require(iterations >= 0, "a peer's iterations must not be negative");
  for (const PeerOffer& offer : offers()) {
    for (const PeerEntry& entry : offer.entries) {
      if (entry.method.name == method) {
        const int standard = entry.method.iterations;  // 0: it does not iterate, whatever is asked
        return entry.start(world, standard > 0 && iterations > 0 ? iterations : standard);
      }
    }
  }
  throw std::invalid_argument("no peer '" + method + "' was found when this was built");
}

}  // namespace app
