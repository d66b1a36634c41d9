// Steps a scene in several engines, frame by frame in turn, and measures each.
#pragma once

#include <optional>

#include "app/base/progress.h"
#include "app/race/race_verdict.h"

namespace app {

// Nothing: interrupted. Throws InputError where fewer than two of the engines can run the scene.
std::optional<Race> runRace(const scenes::Scene& scene, const std::vector<std::string>& engines,
                            const RaceLimits& limits, ProgressMode progress);

}  // namespace app
