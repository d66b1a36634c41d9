// Runs a scene with and without each of its effects.
#include "app/study/study_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/build_info.h"
#include "app/base/interrupt.h"
#include "app/base/machine.h"
#include "app/base/stopwatch.h"
#include "app/study/study_effort.h"

namespace app {

namespace {

using Kind = EffectTrial::Kind;
using Status = StudyPoint::Status;

// Where a run ended.
struct End {
  std::vector<physics::Vec3> places;  // of the bodies that move
  double energy = 0;                  // J
  std::vector<scenes::Checker::Verdict> verdicts;
};

struct Measured {
  scenes::Scene scene;
  EffectRow row;
  End end;
  std::vector<double> seconds;  // per simulated second, of each repeat
};

double simulated(const scenes::Scene& scene, int steps) {
  return static_cast<double>(steps) / scene.fps;
}

// The checker's metrics look at every frame.
void look(const scenes::Simulation& simulation, scenes::Checker& checker, End& end) {
  checker.observe(simulation);
  end.energy = simulation.metrics().total;
}

// The warm-up: not timed, but looked at.
void runOnce(int steps, Measured& m) {
  StudyPoint& point = m.row.point;
  scenes::Simulation simulation(m.scene);
  scenes::Checker checker(m.scene);
  look(simulation, checker, m.end);
  for (int k = 0; k < steps && point.isOk() && !interrupted(); ++k) {
    const physics::StepReport report = simulation.advance();
    point.evaluations += static_cast<double>(report.constraintEvaluations);
    point.sweeps += report.iterations;
    if (report.notFinite) {
      point.status = Status::kNotFinite;
      point.message = fmt::format("not finite in the step from frame {}", simulation.frame());
    }
    look(simulation, checker, m.end);
    const double overlap = simulation.world().largestOverlap();
    point.worst.overlap = std::max(point.worst.overlap, overlap);
  }
  point.evaluations /= simulated(m.scene, steps);
  point.sweeps /= simulated(m.scene, steps);
  m.end.verdicts = checker.verdicts();
  const physics::Bodies& bodies = simulation.world().bodies();
  for (physics::BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] != physics::Motion::kStatic) m.end.places.push_back(bodies.pose[b].x);
  }
}

double secondsOf(const scenes::Scene& scene, int steps) {
  scenes::Simulation simulation(scene);
  simulation.advance();  // settles what touches, and allocates: not timed
  const double before = processorSeconds();
  for (int k = 1; k < steps && !interrupted(); ++k) simulation.advance();
  return (processorSeconds() - before) / simulated(scene, steps - 1);
}

void compareEnds(const End& whole, Measured& m) {
  StudyPoint& point = m.row.point;
  const auto count = std::min(whole.places.size(), m.end.places.size());
  double sum = 0, largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double square = (m.end.places[i] - whole.places[i]).squaredNorm();
    sum += square;
    largest = std::max(largest, square);
  }
  point.errors = {count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0, std::sqrt(largest),
                  static_cast<int>(count)};
  point.worst.energyDrift = m.end.energy - whole.energy;
  for (std::size_t i = 0; i < std::min(whole.verdicts.size(), m.end.verdicts.size()); ++i) {
    if (!whole.verdicts[i].holds || m.end.verdicts[i].holds) continue;
    point.message += (point.message.empty() ? "" : "; ") + m.end.verdicts[i].text;
  }
}

void fillTimes(Measured& m) {
  StudyPoint& point = m.row.point;
  std::sort(m.seconds.begin(), m.seconds.end());
  const std::size_t n = m.seconds.size();
  if (n == 0) return;
  point.repeats = static_cast<int>(n);
  point.wall = m.seconds.front();
  point.wallMedian = point.processor = medianOf(m.seconds);
  const double middle = m.seconds[(3 * (n - 1) + 2) / 4] - m.seconds[(n - 1) / 4];
  point.wallSpread = point.processor > 0 ? middle / 2 / point.processor : 0;
}

// Its scene, and the point with nothing measured yet.
Measured prepare(const std::string& scene, const std::vector<std::string>& overrides,
                 const EffectTrial& trial, int steps) {
  Measured m;
  m.row.trial = trial;
  std::vector<std::string> set = overrides;
  set.insert(set.end(), trial.set.begin(), trial.set.end());
  StudyPoint& point = m.row.point;
  point.load = loadAverage();
  try {
    m.scene = scenes::readScene(scene, set);
    point.key = {m.scene.name, trial.name, steps, m.scene.settings.substeps, 0};
    point.h = 1.0 / (m.scene.fps * m.scene.settings.substeps);
  } catch (const scenes::InputError& error) {
    point.key.method = trial.name;
    point.status = Status::kRefused;
    point.message = error.what();
  }
  return m;
}

// False: interrupted.
bool measureAll(int steps, const StepEffort& effort, std::vector<Measured>& all) {
  for (Measured& m : all) {
    if (m.row.point.isOk()) runOnce(steps, m);
    if (interrupted()) return false;
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].row.point.isOk()) compareEnds(all[0].end, all[i]);
  }
  const Stopwatch watch;
  for (int k = 0; k < effort.repeats && (k < 2 || watch.seconds() < effort.longest); ++k) {
    for (Measured& m : all) {
      if (m.row.point.isOk()) m.seconds.push_back(secondsOf(m.scene, steps));
      if (interrupted()) return false;
    }
  }
  for (Measured& m : all) fillTimes(m);
  return true;
}

// True: all of them were measured before.
bool takeKnown(const PointStore& store, const std::string& inputs, std::vector<Measured>& all) {
  for (Measured& m : all) {
    const StudyPoint* known = store.find(m.row.point.key, inputs);
    if (known == nullptr) return false;
    m.row.point = *known;
  }
  return true;
}

}  // namespace

const EffectRow* EffectResults::find(Kind kind) const {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const EffectRow& row) { return row.trial.kind == kind; });
  return found == rows.end() ? nullptr : &*found;
}

double EffectResults::saved(const StudyPoint& point) const {
  return point.processor > 0 ? 1 - asItIs().processor / point.processor : 0;
}

double EffectResults::noise(const StudyPoint& point) const {
  const double ratio = point.processor > 0 ? asItIs().processor / point.processor : 0;
  return ratio * std::hypot(point.wallSpread, asItIs().wallSpread);
}

std::vector<EffectTrial> effectTrials(const std::vector<scenes::Effect>& effects) {
  std::vector<EffectTrial> trials{{Kind::kAsItIs, "as it is", {}}};
  for (const scenes::Effect& effect : effects) {
    if (effect.on && !effect.without.empty()) {
      trials.push_back({Kind::kWithout, effect.name, effect.without});
    }
  }
  trials.push_back({Kind::kNothingLeftOut, "nothing left out", {"simulation.leave_out=false"}});
  trials.push_back({Kind::kEverythingOn, "everything on", scenes::everythingOn()});
  return trials;
}

std::optional<EffectResults> measureEffects(const std::string& word,
                                            const std::vector<std::string>& overrides,
                                            const StepEffort& effort, PointStore& store) {
  const scenes::Scene scene = scenes::readScene(word, overrides);
  EffectResults results{scene.name, scene.title, scene.fps, scenes::effectsOf(scene), {}};
  const int steps = std::max(2, std::min(effort.steps, scene.frameCount() - 1));
  const std::string inputs = hashText(programHash() + scene.text + joinedLines(overrides) +
                                      std::to_string(effort.repeats));
  std::vector<Measured> all;
  for (const EffectTrial& trial : effectTrials(results.effects)) {
    all.push_back(prepare(word, overrides, trial, steps));
    StudyPoint& point = all.back().row.point;
    point.key.study = scene.name;
    point.key.steps = steps;
  }
  if (!takeKnown(store, inputs, all)) {
    if (!measureAll(steps, effort, all)) return std::nullopt;
    for (Measured& m : all) {
      m.row.point.inputs = inputs;
      store.append(m.row.point);
    }
  }
  for (Measured& m : all) results.rows.push_back(std::move(m.row));
  return results;
}

}  // namespace app
