// Bullet was not found when this was configured.
#include "app/peers/engines.h"

namespace app {

PeerOffer bulletOffer() { return {{"Bullet", "", "libbullet-dev"}, {}}; }

}  // namespace app
