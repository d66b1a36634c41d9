// A scene's whole way from text to a picture, cut short.
#include "tests/fuzz/try_scene.h"

#include <algorithm>
#include <cctype>

#include "scenes/measure/metrics.h"
#include "scenes/view/view.h"

namespace tests {
namespace {

constexpr int kSteps = 3, kMostSweeps = 20, kMostSubsteps = 2;
constexpr int kMostSeen = 3000;  // bodies
constexpr int kMostWork = 2000;  // bodies times substeps of a step: more is not stepped again

void cutShort(physics::Settings& settings) {
  settings.substeps = std::min(settings.substepCount(), kMostSubsteps);
  settings.iterations = std::min(settings.iterations, kMostSweeps);
}

void look(const scenes::Simulation& simulation) {
  scenes::MotionBounds bounds;
  bounds.include(simulation);
  scenes::ViewOptions options;
  options.overlays = simulation.scene().overlays;
  options.hud = true;
  view(simulation, bounds, options, {simulation.metrics()});
}

Tried run(const scenes::Scene& scene, int mostStepped) {
  scenes::Simulation simulation(scene);
  scenes::Checker checker(scene);
  const int bodies = simulation.world().bodyCount();
  if (bodies > kMostSeen) return {app::ExitCode::kDone, ""};
  for (int k = 0;; ++k) {
    checker.observe(simulation);
    look(simulation);
    if (k == kSteps || bodies > mostStepped) return {app::ExitCode::kDone, ""};
    const physics::StepReport report = simulation.advance();
    if (report.notFinite) return {app::ExitCode::kCheckFailed, report.notFinite->constraint};
    if (report.substeps * bodies > kMostWork) return {app::ExitCode::kDone, ""};
  }
}

// Digits at `at`, not beginning with 0, and ':' behind them: moves `at` past it.
bool passNumber(const std::string& text, std::size_t& at) {
  const std::size_t first = at;
  while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) ++at;
  return at > first && text[first] != '0' && at < text.size() && text[at++] == ':';
}

}  // namespace

Tried tryScene(const std::string& text, const std::string& path, int mostStepped) {
  try {
    scenes::Scene scene = scenes::parseScene(text, path);
    cutShort(scene.settings);
    return run(scene, mostStepped);
  } catch (const scenes::InputError& error) {
    return {app::ExitCode::kBadInput, error.what()};
  }
}

bool hasPlace(const std::string& told, const std::string& path) {
  std::size_t at = path.size() + 1;
  return told.rfind(path + ":", 0) == 0 && passNumber(told, at) && passNumber(told, at);
}

}  // namespace tests
