// A page that plays a run in a browser: one file, opened from disk, that asks nothing of a network.
#pragma once

#include <string>

#include "app/take/take.h"

namespace app {

// `shown`: which overlays are switched on at first.
std::string playerPage(const Take& take, const scenes::Scene& scene, const scenes::Overlays& shown);

}  // namespace app
