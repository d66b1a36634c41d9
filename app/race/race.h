// A race: the same scene in several engines, and what was measured of each, frame by frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/race/race_engines.h"
#include "physics/base/types.h"
#include "scenes/scene.h"

namespace app {

struct RaceSample {         // of one frame
  double milliseconds = 0;  // of the processor, that the engine took to get here
  double overlap = 0;       // the deepest of two bodies [m]
  double overlapShare = 0;  // the largest, of how thick the thinner one is
  double gap = 0;           // the largest of a joint [m]
  double gapShare = 0;      // the largest, of the size of the smaller body that it joins
  double energy = 0;        // kinetic, of gravity and of springs [J]
  double energyChange = 0;  // since the start, of the larger of what it was and the most that moved
};

struct RaceBreak {  // the first thing that went wrong
  int frame = 0;
  std::string what;  // "joint gap 1.3 % of the smaller body"
};

struct RaceTrack {  // of one engine
  RaceEntry entry;
  std::vector<RaceSample> samples;                // from frame 0 until it gave up
  std::vector<std::vector<physics::Pose>> poses;  // of the same frames, by BodyId; for the film
  std::optional<RaceBreak> missed;                // what the scene expects of its bodies
  std::optional<RaceBreak> gaveUp;                // the engine, or its numbers
  std::optional<RaceBreak> broke;                 // the first of all criteria

  bool ran() const { return entry.refusal.empty(); }
};

struct Race {
  scenes::Scene scene;
  int frames = 0;          // of the whole race
  std::string energyNote;  // why energy does not count; empty: it does
  bool hasJoints = false, hasContacts = false;
  std::vector<RaceTrack> tracks;
};

}  // namespace app
