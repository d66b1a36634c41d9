// What the steps of a scene take, and what they take it for.
#include "app/run/step_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/base/interrupt.h"
#include "app/base/stopwatch.h"
#include "physics/base/profile.h"
#include "physics/motion/free_motion.h"

namespace app {

namespace {

// Adds the time between two turns to what the step was at. Words are few: their addresses are
// searched, and told apart by their text in the end.
class WorkClock {
 public:
  void turn(const char* work) {
    const double passed = watch_.lap();
    entries_[at_].second += passed;
    for (at_ = 0; at_ < entries_.size(); ++at_) {
      if (entries_[at_].first == work) return;
    }
    entries_.emplace_back(work, 0.0);
  }
  std::map<std::string, double> shares() const {
    double total = 0;
    for (const auto& [work, seconds] : entries_) total += seconds;
    std::map<std::string, double> shares;
    for (const auto& [work, seconds] : entries_) shares[work] += total > 0 ? seconds / total : 0;
    return shares;
  }

 private:
  Stopwatch watch_;
  std::vector<std::pair<const char*, double>> entries_{{"", 0.0}};
  std::size_t at_ = 0;
};

struct Run {
  int steps = 0;  // that are counted and timed
  double seconds = 0, evaluations = 0, sweeps = 0, contacts = 0;
  std::string problem;
};

Run runSteps(scenes::Simulation& simulation, int steps) {
  Run run;
  if (simulation.advance().notFinite) run.problem = "not finite in the first step";
  if (!run.problem.empty()) return run;
  for (; run.steps < steps && !interrupted(); ++run.steps) {
    const Stopwatch watch;
    const physics::StepReport report = simulation.advance();
    run.seconds += watch.seconds();
    run.evaluations += static_cast<double>(report.constraintEvaluations);
    run.sweeps += report.iterations;
    run.contacts += simulation.world().contactCount();
    if (report.notFinite) {
      run.problem = fmt::format("not finite in the step from frame {}", simulation.frame());
      break;
    }
  }
  return run;
}

// What steps from there turn to. The clock is read between steps too, and counts for the rest.
std::map<std::string, double> listen(const scenes::Scene& scene, int steps) {
  scenes::Simulation simulation(scene);
  simulation.advance();
  WorkClock clock;
  const physics::Listening listening([&](const char* work) { clock.turn(work); });
  for (int k = 0; k < steps && !interrupted(); ++k) {
    if (simulation.advance().notFinite) break;
  }
  clock.turn("");
  return clock.shares();
}

double secondsOfMotion(physics::Bodies bodies, const std::optional<physics::Vec3>& gravity) {
  constexpr int kMoves = 8;
  const std::vector<physics::Load> loads(static_cast<std::size_t>(bodies.size()));
  const Stopwatch watch;
  for (int k = 0; k < kMoves; ++k) physics::moveFreely(bodies, loads, gravity, 1e-4);
  return watch.seconds();
}

void makeIsotropic(physics::Bodies& bodies) {
  for (physics::Vec3& i : bodies.inertia) i.setConstant(i.x());
  for (physics::Vec3& i : bodies.inverseInertia) i.setConstant(i.x());
}

void makePoints(physics::Bodies& bodies) {
  for (physics::Vec3& i : bodies.inverseInertia) i.setZero();
  for (physics::Velocity& velocity : bodies.velocity) velocity.w.setZero();
}

// The part of `shares` that is free motion, shared among its effects.
void splitMotion(const physics::World& world, int repeats, std::map<std::string, double>& shares) {
  const physics::Bodies& all = world.bodies();
  const std::optional<physics::Vec3>& gravity = world.settings().gravity;
  physics::Bodies isotropic = all;
  makeIsotropic(isotropic);
  physics::Bodies points = isotropic;
  makePoints(points);
  std::vector<double> whole, withoutGravity, withoutGyroscopic, withoutTurning;
  for (int k = 0; k < std::max(repeats, 3); ++k) {
    whole.push_back(secondsOfMotion(all, gravity));
    withoutGravity.push_back(secondsOfMotion(all, {}));
    withoutGyroscopic.push_back(secondsOfMotion(isotropic, {}));
    withoutTurning.push_back(secondsOfMotion(points, {}));
  }
  const double total = medianOf(whole), motion = shares["motion"];
  if (!(total > 0)) return;
  double left = total;
  const auto take = [&](const char* effect, const std::vector<double>& without) {
    const double rest = std::min(left, medianOf(without));
    shares[effect] = motion * (left - rest) / total;
    left = rest;
  };
  take("gravity", withoutGravity);
  take("gyroscopic_torque", withoutGyroscopic);
  take("rotation", withoutTurning);
  shares["motion"] = motion * left / total;
}

std::map<std::string, double> medians(const std::vector<std::map<std::string, double>>& runs) {
  std::map<std::string, std::vector<double>> byWork;
  for (const auto& shares : runs) {
    for (const auto& [work, share] : shares) byWork[work].push_back(share);
  }
  std::map<std::string, double> result;
  double sum = 0;
  for (auto& [work, shares] : byWork) {
    shares.resize(runs.size(), 0.0);
    sum += result[work] = medianOf(shares);
  }
  result[""] += 1 - sum;  // medians need not sum to the whole
  return result;
}

}  // namespace

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

StepMeasure measureSteps(const scenes::Scene& scene, const StepEffort& effort) {
  StepMeasure measure;
  const int steps = std::min(effort.steps, scene.frameCount() - 2);
  if (steps < 1) {
    measure.problem = "no step to measure";
    return measure;
  }
  scenes::Simulation first(scene);
  const Run warmUp = runSteps(first, steps);
  measure.steps = warmUp.steps;
  measure.problem = warmUp.problem;
  if (warmUp.steps == 0 || interrupted()) return measure;
  const double count = warmUp.steps;
  measure.evaluations = warmUp.evaluations / count;
  measure.sweeps = warmUp.sweeps / count;
  measure.contacts = warmUp.contacts / count;
  std::vector<double> seconds;
  std::vector<std::map<std::string, double>> shares;
  const Stopwatch watch;
  while (measure.repeats == 0 ||
         (measure.repeats < effort.repeats && watch.seconds() < effort.longest)) {
    scenes::Simulation simulation(scene);
    seconds.push_back(runSteps(simulation, warmUp.steps).seconds / count);
    shares.push_back(listen(scene, warmUp.steps));
    ++measure.repeats;
    if (interrupted()) return measure;
  }
  measure.seconds = medianOf(seconds);
  const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
  measure.spread = *least > 0 ? *most / *least - 1 : 0;
  measure.shares = medians(shares);
  splitMotion(first.world(), effort.repeats, measure.shares);
  return measure;
}

}  // namespace app
