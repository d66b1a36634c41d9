// The steps that islands choose by the accuracy, over time.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "physics/small_steps/island_plan.h"
#include "render/chart.h"
#include "scenes/simulation.h"

namespace physics {
class Archive;
}

namespace app {

// Listens to the steps that this thread makes of a simulation, as long as it lives.
class StepsChart {
 public:
  // Throws InputError where the scene asks for no accuracy.
  explicit StepsChart(const scenes::Simulation& simulation);
  StepsChart(const StepsChart&) = delete;

  // The shortest step of every frame, island by island where they are few, else of that island
  // whose is shortest and of that whose is longest; below, how many steps all together took, and
  // how many were rejected.
  void write(const std::filesystem::path& file) const;
  void archive(physics::Archive& a);  // of what it has heard so far

 private:
  using Frames = std::map<int, physics::AccuracyReport>;

  void take(const physics::IslandSteps& told);
  double timeOf(int frame) const;
  void addIslands(render::Chart& chart) const;
  void addEnds(render::Chart& chart) const;
  render::Chart steps() const;
  render::Chart counts() const;

  const scenes::Simulation& simulation_;
  std::map<physics::BodyId, Frames> islands_;  // by their first body
  physics::StepListening listening_;
};

}  // namespace app
