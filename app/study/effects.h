// Measuring what each effect of a scene costs and what it changes: the same steps with it and
// without it, side by side.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/report.h"
#include "app/study/store.h"
#include "scenes/effects.h"

namespace app {

// One way to run the scene.
struct EffectTrial {
  enum class Kind { kAsItIs, kWithout, kNothingLeftOut, kEverythingOn };
  Kind kind = Kind::kAsItIs;
  std::string name;              // "gravity"; "as it is"
  std::vector<std::string> set;  // besides the scene's own overrides
};

// What was measured: `error` is the rms distance of all bodies that move, at the last step, from
// where they are as it is [m]; `last_error` that of the largest; `energy_drift` the difference of
// the energies there [J]; times are those of the processor per simulated second, `processor` their
// median, `wall_spread` half of their middle half's width, relative; `message` what is expected of
// the scene and holds no more.
struct EffectRow {
  EffectTrial trial;
  Trace trace;
};

struct EffectResults {
  std::string name, title;
  int fps = 60;
  std::vector<scenes::Effect> effects;
  std::vector<EffectRow> rows;  // the first is the scene as it is; empty: not measured

  const EffectRow* find(EffectTrial::Kind kind) const;  // null: not measured
  // Of the time of a row that does more, the share that the scene as it is saves; of the scene's,
  // what leaving an effect out saves; and the noise of either.
  double saved(const EffectRow& row) const;
  double noise(const EffectRow& row) const;
};

std::vector<EffectTrial> effectTrials(const std::vector<scenes::Effect>& effects);
std::string listText(const std::vector<scenes::Effect>& effects);  // names of those of the step
std::string effectsText(const EffectResults& results);             // for standard output
std::string effectsRow(const EffectResults& results);              // of the README's table
ReportSection effectsSection(const EffectResults& results);

}  // namespace app
