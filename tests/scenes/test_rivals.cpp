// Every rival method takes every kind of scene of the library.
#include <gtest/gtest.h>

#include <tuple>

#include "scenes/simulation.h"

namespace scenes {
namespace {

using Case = std::tuple<std::string, std::string>;  // method, scene
class RivalScenes : public testing::TestWithParam<Case> {};

TEST_P(RivalScenes, RunThirtyStepsWithFiniteNumbers) {
  const auto& [method, name] = GetParam();
  std::vector<std::string> overrides{"simulation.method=" + method};
  // Explicit steps need short ones: the net's own dampers have 4 zeta omega h = 5 at the scene's.
  if (method == "penalty_explicit") overrides.push_back("simulation.substeps=40");
  // The lengths of whole rows and columns leave no zero in the cloth's matrix: half a second a
  // step.
  const bool isDense = method == "penalty" && name == "cloth_hang";
  if (isDense) overrides.push_back("simulation.iterations=1");
  Simulation simulation(readScene(name, overrides));
  for (int k = 0; k < (isDense ? 3 : 30); ++k) {
    const physics::StepReport report = simulation.advance();
    ASSERT_FALSE(report.notFinite) << report.notFinite->constraint << " in step " << k;
    ASSERT_GT(report.constraintEvaluations, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Library, RivalScenes,
    testing::Combine(testing::Values("xpbd", "sequential_impulses", "penalty", "penalty_explicit"),
                     testing::Values("pendulum", "chain", "stack", "wrecking_ball", "cloth_hang",
                                     "spring_net", "ragdoll_stairs")),
    [](const auto& info) { return std::get<0>(info.param) + "_" + std::get<1>(info.param); });

}  // namespace
}  // namespace scenes
