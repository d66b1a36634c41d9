// dbd plan: what is simulated of a scene and what is not, why, and what it costs.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/plan/plan.h"
#include "app/run/run_record.h"

namespace app {

namespace {

constexpr int kMostSteps = 1'000'000, kMostRepeats = 1000;

struct PlanOptions {
  CommonOptions common;
  StepEffort effort;
  bool json = false;
};

ExitCode plan(const PlanOptions& options) {
  const scenes::Scene scene = options.common.readScene();
  noteWarnings(scene.name, scene.told);
  const Plan plan = makePlan(scene, options.effort);
  if (interrupted()) {
    note("dbd: interrupted; nothing was printed\n");
    return ExitCode::kInterrupted;
  }
  say(options.json ? jsonText(planJson(plan), 2) + "\n" : planText(plan));
  return plan.step.problem.empty() ? ExitCode::kDone : ExitCode::kCheckFailed;
}

constexpr const char* kPlanHelp =
    "What a scene simulates and what it leaves out, why, and what it costs\n\n"
    "Every effect there is, on or off, with the scene's line that switches it on or the reason why "
    "it\n"
    "cannot matter, how much it acts on, the bytes it holds, and its share of a step's time, "
    "measured\n"
    "here over the scene's first steps.";

}  // namespace

void addPlan(CLI::App& line, Action& action) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = line.add_subcommand("plan", kPlanHelp);
  addScene(*command, options->common);
  command->add_flag("--json", options->json, "As JSON; app/plan/plan.h says what is in it");
  command->add_option("--steps", options->effort.steps, "Frames of a run [60]")
      ->check(CLI::Range(1, kMostSteps))
      ->type_name("N");
  command->add_option("--repeats", options->effort.repeats, "Runs, at the most [5]")
      ->check(CLI::Range(1, kMostRepeats))
      ->type_name("N");
  addOverrides(*command, options->common);
  command->callback([options, &action] { action = [options] { return plan(*options); }; });
}

}  // namespace app
