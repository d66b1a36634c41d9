// Collects what islands tell, and draws it.
#include "app/trust/steps_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/trust/trust_chart.h"
#include "physics/base/archive.h"
#include "scenes/archive.h"
#include "scenes/view/palette.h"

namespace app {

namespace {

render::Color colourOf(int index) {
  return scenes::familyColor(scenes::Pattern::kVaried, 0, index);
}

}  // namespace

StepsChart::StepsChart(const scenes::Simulation& simulation)
    : simulation_(simulation), listening_([this](const auto& told) { take(told); }) {
  if (!simulation.scene().settings.accuracy) {
    throw scenes::InputError(
        "--steps-chart: expected a scene with an accuracy, as --accuracy 1e-3 gives it one");
  }
}

// During the step to the next frame.
void StepsChart::take(const physics::IslandSteps& told) {
  add(told.steps, islands_[told.first][simulation_.frame() + 1]);
}

void StepsChart::archive(physics::Archive& a) { a(islands_); }

double StepsChart::timeOf(int frame) const {
  return static_cast<double>(frame) / simulation_.scene().fps;
}

void StepsChart::addIslands(render::Chart& chart) const {
  for (const auto& [first, frames] : islands_) {
    render::ChartCurve curve{"island of " + simulation_.bodyName(first),
                             {},
                             colourOf(static_cast<int>(chart.curves.size()))};
    int before = -1;
    for (const auto& [frame, told] : frames) {
      if (!(told.least > 0)) continue;
      if (before >= 0 && frame > before + 1) curve.points.push_back({timeOf(frame), NAN});
      curve.points.push_back({timeOf(frame), told.least});
      before = frame;
    }
    chart.curves.push_back(std::move(curve));
  }
}

void StepsChart::addEnds(render::Chart& chart) const {
  std::map<int, std::pair<double, double>> ends;  // of a frame: the shortest, the longest
  for (const auto& [first, frames] : islands_) {
    for (const auto& [frame, told] : frames) {
      if (!(told.least > 0)) continue;
      auto& [least, most] = ends.try_emplace(frame, told.least, told.least).first->second;
      least = std::min(least, told.least);
      most = std::max(most, told.least);
    }
  }
  render::ChartCurve longest{"longest of all islands", {}, colourOf(1)};
  render::ChartCurve shortest{"shortest of all islands", {}, colourOf(0)};
  for (const auto& [frame, end] : ends) {
    shortest.points.push_back({timeOf(frame), end.first});
    longest.points.push_back({timeOf(frame), end.second});
  }
  chart.curves.push_back(std::move(longest));
  chart.curves.push_back(std::move(shortest));
}

render::Chart StepsChart::steps() const {
  constexpr std::size_t kFew = 6;
  render::Chart chart;
  chart.y = {"shortest step in a frame [s]", true, {}, {}};
  if (islands_.size() <= kFew) {
    addIslands(chart);
  } else {
    addEnds(chart);
  }
  const double frame = timeOf(1);
  chart.curves.push_back(
      {"a frame", {{0, frame}, {timeOf(simulation_.frame()), frame}}, {0, 0, 0, 1}, true, true});
  chart.x = {"", false, 0, std::max(timeOf(simulation_.frame()), frame)};
  return chart;
}

render::Chart StepsChart::counts() const {
  Frames all;
  for (int frame = 1; frame <= simulation_.frame(); ++frame) all[frame];
  for (const auto& [first, frames] : islands_) {
    for (const auto& [frame, told] : frames) {
      add(told, all[frame]);
    }
  }
  render::ChartCurve taken{"taken", {}, colourOf(0)}, rejected{"rejected", {}, colourOf(5)};
  for (const auto& [frame, told] : all) {
    taken.points.push_back({timeOf(frame), told.accepted});
    rejected.points.push_back({timeOf(frame), told.rejected});
  }
  render::Chart chart;
  chart.x = {"time [s]", false, 0, std::max(timeOf(simulation_.frame()), timeOf(1))};
  chart.y = {"steps in a frame, all islands", false, 0, {}};
  chart.curves = {taken, rejected};
  return chart;
}

void StepsChart::write(const std::filesystem::path& file) const {
  const scenes::Scene& scene = simulation_.scene();
  writeCharts(fmt::format("{}: steps at accuracy {:g}", scene.name, *scene.settings.accuracy),
              {steps(), counts()}, file);
}

}  // namespace app
