// Measuring what each effect of a scene costs and what it changes: the same steps with it and
// without it, side by side.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/step_clock.h"
#include "app/study/study_point.h"
#include "scenes/effects.h"

namespace app {

// One way to run the scene.
struct EffectTrial {
  enum class Kind { kAsItIs, kWithout, kNothingLeftOut, kEverythingOn };
  Kind kind = Kind::kAsItIs;
  std::string name;              // "gravity"; "as it is"
  std::vector<std::string> set;  // besides the scene's own overrides
};

// What was measured, as a StudyPoint: `error` is the rms distance of all bodies that move, at the
// last step, from where they are as it is [m]; `last_error` that of the largest; `energy_drift` the
// difference of the energies there [J]; times are those of the
// processor per simulated second, `processor` their median, `wall_spread` half of their middle
// half's width, relative; `message` what is expected of the scene and holds no more.
struct EffectRow {
  EffectTrial trial;
  StudyPoint point;
};

struct EffectResults {
  std::string name, title;
  int fps = 60;
  std::vector<scenes::Effect> effects;
  std::vector<EffectRow> rows;  // the first is the scene as it is

  const StudyPoint& asItIs() const { return rows.front().point; }
  const EffectRow* find(EffectTrial::Kind kind) const;  // null: not measured
  double saved(const StudyPoint& point) const;  // share of `point`'s time that as it is saves
  double noise(const StudyPoint& point) const;  // of that share
};

std::vector<EffectTrial> effectTrials(const std::vector<scenes::Effect>& effects);

// Runs all trials in turn, `effort.repeats` times over after a warm-up that also compares their
// ends; stops repeating when `effort.longest` is spent. What `store` has is not measured again.
// None: interrupted.
std::optional<EffectResults> measureEffects(const std::string& scene,
                                            const std::vector<std::string>& overrides,
                                            const StepEffort& effort, PointStore& store);

std::string listText(const std::vector<scenes::Effect>& effects);  // names of those of the step
std::string effectsText(const EffectResults& results);             // for standard output
std::string effectsSection(const EffectResults& results, bool plotted);  // HTML
std::string effectsRow(const EffectResults& results);                    // of the README's table
std::string effectsScript(const EffectResults& results);  // draws NAME.svg and NAME.png

}  // namespace app
