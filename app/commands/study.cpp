// dbd study: the measurements that answer what methods and choices are worth.
#include <CLI/CLI.hpp>

#include "app/commands/commands.h"
#include "app/commands/study_commands.h"

namespace app {

void addStudy(CLI::App& line, Action& action) {
  CLI::App* command = line.add_subcommand("study", "Measure methods, choices and stability");
  command->require_subcommand(1);
  addAccuracyStudy(*command, action);
  addOptionStudy(*command, action);
  addEffectStudy(*command, action);
  addStabilityStudy(*command, action);
}

}  // namespace app
