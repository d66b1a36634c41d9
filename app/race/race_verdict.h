// Who broke first, and what counts as broken.
#pragma once

#include <string>

#include "app/race/race.h"

namespace app {

// Shares without a unit, the same for every scene and every engine.
struct RaceLimits {
  double gap = 0.01;     // of a joint, of the size of the smaller body: an eye sees it
  double overlap = 0.1;  // of how thick the thinner body is: as where a start is warned of
  double energy = 0.01;  // that came from nowhere, as RaceSample::energyChange
};

// The measure that is beyond its limit in a frame, as RaceBreak::what; empty: none.
std::string beyondLimits(const RaceSample& sample, const RaceLimits& limits, bool energyCounts);

// The first of: a measure beyond its limit, an expectation missed, an engine that gave up.
std::optional<RaceBreak> findBreak(const RaceTrack& track, const RaceLimits& limits,
                                   bool energyCounts);

// "Broke first, at 0.35 s Bullet 3.24: joint gap ...", a line each, and who held.
std::string raceVerdict(const Race& race);

// The criteria in words, a line each.
std::vector<std::string> criteriaOf(const Race& race, const RaceLimits& limits);

}  // namespace app
