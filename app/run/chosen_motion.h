// Which motion a run draws: one that is there, or a new one.
#pragma once

#include "app/run/motion.h"
#include "app/run/render_run.h"

namespace app {

struct ChosenMotion {
  Motion motion;
  bool isWhole = false;  // all frames that are needed are there; else none are yet
};

// `start`: the scene before its first step.
ChosenMotion chooseMotion(const scenes::Simulation& start, const RenderJob& job,
                          const RunRecord& record);

// What a run drew from. Throws InputError where it is not there.
Motion drawnMotion(const scenes::Simulation& start, const RenderJob& job);

// A camera that fits the motion wants all of it.
int framesNeeded(const scenes::Scene& scene, const RenderJob& job);

// What a motion's file says of the run, whose verdicts are in the record.
Json describeMotion(const scenes::Scene& scene, const RunRecord& record);

}  // namespace app
