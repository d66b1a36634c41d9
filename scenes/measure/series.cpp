// Takes the values of named metrics at every frame.
#include "scenes/measure/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace scenes {
namespace {

double valueOf(const Metric& metric, const Sample& sample) {
  if (metric.scene != nullptr) return metric.scene(sample);
  double largest = -std::numeric_limits<double>::infinity();
  for (const physics::BodyId body : sample.bodies) {
    const double value = metric.body(sample, body);
    if (!(value <= largest)) largest = value;
  }
  return largest;
}

}  // namespace

bool isClock(const std::string& metric) {
  return metric == "time" || metric == "frame" || metric == "iteration";
}

std::string unitOf(const std::string& metric) {
  if (isClock(metric)) return metric == "time" ? "s" : "";
  const Metric* found = findMetric(metric);
  return found == nullptr ? "" : found->unit;
}

const std::vector<double>& Series::of(const MetricOf& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::out_of_range("series: no " + name.metric);
  return values[static_cast<size_t>(found - names.begin())];
}

std::vector<double> Series::along(const MetricOf& name) const {
  if (!isClock(name.metric)) return of(name);
  const double scale = name.metric == "time"    ? 1.0 / fps
                       : name.metric == "frame" ? 1.0
                                                : 1.0 * sweepsPerFrame;
  std::vector<double> clock;
  for (int frame = 0; frame < frameCount(); ++frame) clock.push_back(scale * frame);
  return clock;
}

SeriesRecorder::SeriesRecorder(const Simulation& simulation, std::vector<MetricOf> names) {
  const Scene& scene = simulation.scene();
  series_.fps = scene.fps;
  series_.sweepsPerFrame = scene.settings.substepCount() * scene.settings.iterations;
  series_.names = std::move(names);
  series_.values.resize(series_.names.size());
  for (const MetricOf& name : series_.names) {
    bodies_.push_back(name.body.empty() ? std::vector<physics::BodyId>()
                                        : matchingBodies(simulation, name.body));
    if (name.body.empty() || !bodies_.back().empty()) continue;
    throw InputError(
        fmt::format("{}: no body '{}' for the metric {}", scene.path, name.body, name.metric));
  }
}

void SeriesRecorder::observe(const Simulation& simulation) {
  sampler_.observe(simulation);
  for (size_t k = 0; k < series_.names.size(); ++k) {
    const Metric* metric = findMetric(series_.names[k].metric);
    series_.values[k].push_back(valueOf(*metric, sampler_.sample(simulation, bodies_[k])));
  }
}

}  // namespace scenes
