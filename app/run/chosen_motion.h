// Which motion a run draws: one that is there, or a new one.
#pragma once

#include <optional>

#include "app/run/checkpoint.h"
#include "app/run/motion.h"
#include "app/run/render_run.h"

namespace app {

struct ChosenMotion {
  Motion motion;
  bool isWhole = false;                  // all frames that are needed are there
  std::optional<Checkpoint> checkpoint;  // else: where it is kept,
  std::optional<physics::Archive>
      state;  // and what follows its frames so far; none: there are none
};

// To be stepped into `path`: from where a run of the same that was stopped left it, or from the
// beginning. Throws InputError where the one that was stopped differs and `fresh` is not asked for.
ChosenMotion beginMotion(const std::filesystem::path& path, const scenes::Simulation& start,
                         int frames, Motion::Keep keep, const RunRecord& record, bool fresh);

// `start`: the scene before its first step.
ChosenMotion chooseMotion(const scenes::Simulation& start, const RenderJob& job,
                          const RunRecord& record);

// Whole, under its name; what was kept beside it goes.
void commit(ChosenMotion& motion, const Json& about);

// "chain: goes on from frame 317", where somebody reads it.
void noteGoesOn(const scenes::Simulation& simulation, ProgressMode progress);

// What a run drew from. Throws InputError where it is not there.
Motion drawnMotion(const scenes::Simulation& start, const RenderJob& job);

// A camera that fits the motion wants all of it.
int framesNeeded(const scenes::Scene& scene, const RenderJob& job);

// What a motion's file says of the run, whose verdicts are in the record.
Json describeMotion(const scenes::Scene& scene, const RunRecord& record);

}  // namespace app
