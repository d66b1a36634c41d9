// MuJoCo was not found when this was configured.
#include "app/peers/engines.h"

namespace app {

PeerOffer mujocoOffer() { return {{"MuJoCo", "", "libmujoco-dev"}, {}}; }

}  // namespace app
