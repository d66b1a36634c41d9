// What is simulated of a scene and what is not, why, and what it costs: `dbd plan`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/run_record.h"
#include "app/run/step_clock.h"
#include "physics/small_steps/island_plan.h"
#include "scenes/effects.h"

namespace app {

struct PlannedEffect {
  scenes::Effect effect;
  std::size_t bytes = 0;
  std::optional<double> share;  // of a step's time; none: of pictures, or part of `within`
  std::string within;           // the effect whose share holds this one's
};

// Islands that the default method does the same with.
struct PlannedIslands {
  int count = 0;
  physics::IslandPlan plan;                   // of the first of them
  std::optional<physics::IslandSteps> steps;  // the same, where it steps by an accuracy
};

struct Plan {
  std::string name, title, path;
  std::vector<std::string> overrides;
  Json settings;    // as run.json has them
  std::string how;  // "direct, bdf2, 60 fps, 4 substeps"
  int bodies = 0, moving = 0, points = 0, turning = 0;
  std::int64_t rows = 0;                  // of all constraints and forces
  double pairsTested = 0, pairsKept = 0;  // per step
  Json work = Json::object();             // per step: how often it did what few scenes call for
  std::size_t bytes = 0;                  // held by the world
  StepMeasure step;
  std::vector<PlannedEffect> effects;
  std::vector<PlannedIslands> islands;  // of the last step; those of most bodies first
  double rest = 0;                      // share of the step that is no effect's
};

Plan makePlan(const scenes::Scene& scene, const StepEffort& effort);

std::string islandsText(const Plan& plan);  // part of:
std::string planText(const Plan& plan);     // at most 100 columns
// Version 1:
//   version, scene {name, title, path, overrides}, settings (as run.json),
//   bodies {all, moving, points, turning}
//   step {seconds, spread, steps, repeats, evaluations, sweeps, contacts, pairs_tested, pairs_kept,
//         rows, bytes, problem}
//   work {broad_phase, narrow_phase, contact_visits, friction_rows, turns, gyroscopic, moves,
//         rest_speeds, made_anew}: per step, physics/model/report.h
//   effects [{name, part, on, left_out, why, count, unit, rows, bytes, share, within, without,
//             stays}] in a fixed order; share is null where it is not measured by itself
//   islands [{count, first, bodies, flies, trees, loops, joints, ropes, cloths, meshes, links,
//             contacts, soft_contacts, substeps, sweeps, asked_by, accuracy {size, tolerance, steps,
//             rejected, order, shortest_step, error_estimate}}]: physics/small_steps/island_plan.h;
//   accuracy is null where it does not step by one;
//   empty: of other methods
//   rest {share}: what is no effect's; all shares sum to 1
Json islandsJson(const Plan& plan);  // part of:
Json planJson(const Plan& plan);

}  // namespace app
