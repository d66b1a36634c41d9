// A race in numbers: a line of words for each measure, a table, race.csv and race.json.
#pragma once

#include <string>

#include "app/race/race_verdict.h"

namespace app {

struct RaceWorst {                           // over a run
  double median = 0, mean = 0, slowest = 0;  // ms of the processor per frame
  double overlap = 0, overlapShare = 0, gap = 0, gapShare = 0;
  double energyMost = 0, energyEnd = 0;  // RaceSample::energyChange
};
RaceWorst worstOf(const RaceTrack& track);

std::string shareText(double share);  // "1.2 %", "35 times"
// Of the last half second: a single frame flickers.
double recentMilliseconds(const RaceTrack& track, int frame, int fps);

std::string raceTable(const Race& race, const RaceLimits& limits);  // with the verdict below
std::string raceCsv(const Race& race);
std::string raceJson(const Race& race, const RaceLimits& limits, const std::string& film);

}  // namespace app
