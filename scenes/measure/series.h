// Metrics of a run, frame by frame, as plots and measures of a figure want them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/measure/sampler.h"

namespace scenes {

struct MetricOf {
  std::string metric, body;  // body: empty where the metric is the scene's
  bool operator==(const MetricOf&) const = default;
};

struct Series {
  int fps = 60;
  int sweepsPerFrame = 1;  // substeps times iterations
  std::vector<MetricOf> names;
  std::vector<std::vector<double>> values;  // per name, one per frame

  int frameCount() const { return values.empty() ? 0 : static_cast<int>(values.front().size()); }
  const std::vector<double>& of(const MetricOf& name) const;  // throws std::out_of_range
  // The same for "time" [s], "frame" and "iteration" too.
  std::vector<double> along(const MetricOf& name) const;
};

// True for "time", "frame" and "iteration", which every run has.
bool isClock(const std::string& metric);
std::string unitOf(const std::string& metric);

class SeriesRecorder {
 public:
  // Throws InputError where no body matches.
  SeriesRecorder(const Simulation& simulation, std::vector<MetricOf> names);

  // Every frame from 0. Of several bodies the largest value counts.
  void observe(const Simulation& simulation);
  const Series& series() const { return series_; }

 private:
  Series series_;
  Sampler sampler_;
  std::vector<std::vector<physics::BodyId>> bodies_;  // per name
};

}  // namespace scenes
