// Runs a scene's [[expect]] along a simulation, keeping the worst value of each.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scenes/archive.h"
#include "scenes/measure/culprit.h"
#include "scenes/measure/sampler.h"

namespace scenes {

// The largest and the smallest value so far, and when.
struct Extremes {
  double most = -std::numeric_limits<double>::infinity(), mostTime = 0;
  double least = std::numeric_limits<double>::infinity(), leastTime = 0;
  bool seen = false;

  void include(double value, double time) {
    if (!seen || value > most || std::isnan(value)) most = value, mostTime = time;
    if (!seen || value < least || std::isnan(value)) least = value, leastTime = time;
    seen = true;
  }
};

struct Watch {
  Expectation expectation;
  const Metric* metric = nullptr;
  std::vector<physics::BodyId> bodies;
  Extremes extremes;
  std::optional<Checker::Failure> failure;

  bool isBroken(double value) const {
    const Expectation& e = expectation;
    return (e.atMost && !(value <= *e.atMost)) || (e.atLeast && !(value >= *e.atLeast));
  }
  void include(const Sample& sample, double value, physics::BodyId body) {
    extremes.include(value, sample.now.time);
    if (failure || !isBroken(value)) return;
    const Culprit culprit = findCulprit(sample, *metric, body);
    failure = Checker::Failure{sample.now.frame, value, culprit.bodies, culprit.constraint};
  }
};

namespace {

// `finite` needs no bound.
Expectation withBound(Expectation expectation) {
  if (!expectation.atMost && !expectation.atLeast) expectation.atLeast = 1;
  return expectation;
}

bool inSpan(const Expectation& expectation, double time) {
  constexpr double kSlack = 1e-9;  // s; times are frame / fps
  return time >= expectation.from.value_or(time) - kSlack &&
         time <= expectation.to.value_or(time) + kSlack;
}

std::string withUnit(double value, const char* unit) {
  return *unit == '\0' ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

// A share of the energy reads better in percent.
std::string amount(double value, const Metric& metric) {
  if (!metric.isEnergyChange || *metric.unit != '\0') return withUnit(value, metric.unit);
  return value == 0 ? "0" : fmt::format("{:.3g} %", 100 * value);
}

// The value that decides, or from a loss to a gain, of which a bound on one side says nothing of
// the other.
std::string valueText(const Checker::Verdict& verdict, const Metric& metric) {
  if (!metric.isEnergyChange) return amount(verdict.value, metric);
  return amount(verdict.least, metric) + " ... " + amount(verdict.most, metric);
}

std::string boundText(const Checker::Verdict& verdict, const Metric& metric) {
  const Expectation& wanted = verdict.expectation;
  if (metric.isEnergyChange && wanted.atMost && wanted.atLeast) {
    return fmt::format(">= {} and <= {}", amount(*wanted.atLeast, metric),
                       amount(*wanted.atMost, metric));
  }
  const std::string text =
      fmt::format("{} {}", verdict.atMost ? "<=" : ">=", amount(verdict.bound, metric));
  if (!metric.isEnergyChange) return text;
  return text + (verdict.atMost ? " (no gain; it says nothing of a loss)"
                                : " (no further loss; it says nothing of a gain)");
}

Checker::Verdict judge(const Watch& watch) {
  Checker::Verdict verdict;
  const Expectation& wanted = watch.expectation;
  verdict.expectation = wanted;
  verdict.failure = watch.failure;
  const Extremes& e = watch.extremes;
  const bool tooMuch = wanted.atMost && !(e.most <= *wanted.atMost);
  const bool tooLittle = wanted.atLeast && !(e.least >= *wanted.atLeast);
  const bool upper = tooMuch || (wanted.atMost && !tooLittle);
  verdict.seen = e.seen;
  verdict.holds = e.seen && !tooMuch && !tooLittle;
  verdict.atMost = upper;
  verdict.least = e.seen ? e.least : 0;
  verdict.most = e.seen ? e.most : 0;
  verdict.bound = upper ? wanted.atMost.value_or(0) : *wanted.atLeast;
  verdict.value = upper ? e.most : e.least;
  verdict.atTime = upper ? e.mostTime : e.leastTime;
  const std::string of = wanted.body.empty() ? "" : " of " + wanted.body;
  if (!e.seen) {
    verdict.text = fmt::format("{}{}: no frame in its span", wanted.metric, of);
    return verdict;
  }
  verdict.text = fmt::format("{}{} {}{} {}", wanted.metric, of, valueText(verdict, *watch.metric),
                             verdict.holds ? "" : ", expected", boundText(verdict, *watch.metric));
  return verdict;
}

}  // namespace

struct Checker::Impl {
  std::vector<Watch> watches;
  Sampler sampler;
  bool begun = false;

  void begin(const Simulation& simulation) {
    begun = true;
    for (Watch& watch : watches) {
      if (watch.expectation.body.empty()) continue;
      watch.bodies = matchingBodies(simulation, watch.expectation.body);
    }
  }
};

Checker::Checker(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  for (const Expectation& expectation : scene.expectations) {
    impl_->watches.push_back({withBound(expectation), findMetric(expectation.metric), {}, {}, {}});
  }
}

Checker::~Checker() = default;

void Checker::observe(const Simulation& simulation) {
  if (!impl_->begun) impl_->begin(simulation);
  impl_->sampler.observe(simulation);
  const double time = impl_->sampler.time();
  for (Watch& watch : impl_->watches) {
    if (!inSpan(watch.expectation, time)) continue;
    const Sample sample = impl_->sampler.sample(simulation, watch.bodies);
    if (watch.metric->scene != nullptr) {
      watch.include(sample, watch.metric->scene(sample), -1);
      continue;
    }
    for (const physics::BodyId body : watch.bodies) {
      watch.include(sample, watch.metric->body(sample, body), body);
    }
  }
}

std::vector<Checker::Verdict> Checker::verdicts() const {
  std::vector<Verdict> verdicts;
  for (const Watch& watch : impl_->watches) verdicts.push_back(judge(watch));
  return verdicts;
}

void Checker::archive(physics::Archive& a) {
  a(impl_->sampler);
  for (Watch& watch : impl_->watches) {
    auto& [most, mostTime, least, leastTime, seen] = watch.extremes;
    a(most, mostTime, least, leastTime, seen, watch.failure);
  }
}

bool Checker::hasFailed() const {
  return std::any_of(impl_->watches.begin(), impl_->watches.end(),
                     [](const Watch& watch) { return watch.failure.has_value(); });
}

}  // namespace scenes
