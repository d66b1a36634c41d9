// What the steps of a scene take, and what they take it for: the clock beside the step's own words
// of what it turns to (physics/base/profile.h).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenes/simulation.h"

namespace app {

struct StepEffort {
  // Of a run, from the scene's start; the scene may be shorter. The first step is made and not
  // timed: it settles what touches, and allocates.
  int steps = 60;
  int repeats = 5;       // runs whose median counts, at the most
  double longest = 2.0;  // s that they may take together
};

struct StepMeasure {
  int steps = 0, repeats = 0;
  double seconds = 0;                    // of a step, the median of the repeats; nobody listened
  double spread = 0;                     // of the slowest repeat beyond the fastest, relative
  std::map<std::string, double> shares;  // of the step's time, by what it turned to; sum to 1
  // Per step, means over the run: they do not depend on the clock.
  double evaluations = 0, sweeps = 0, contacts = 0;
  std::string problem;  // why the run ended early
};

// Runs the scene from its start, again and again. Also shares "motion" among "gravity", "rotation"
// and "gyroscopic_torque": each as what the free motion of the last state takes with it and
// without. Stops early where the user interrupts.
StepMeasure measureSteps(const scenes::Scene& scene, const StepEffort& effort);

double medianOf(std::vector<double> values);  // 0 of none

}  // namespace app
