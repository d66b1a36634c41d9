// ODE was not found when this was configured.
#include "app/peers/engines.h"

namespace app {

PeerOffer odeOffer() { return {{"ODE", "", "libode-dev"}, {}}; }

}  // namespace app
