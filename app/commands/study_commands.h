// The studies, one command each below `dbd study`.
#pragma once

#include "app/commands/options.h"

namespace app {

void addAccuracyStudy(CLI::App& study, Action& action);
void addOptionStudy(CLI::App& study, Action& action);
void addEffectStudy(CLI::App& study, Action& action);
void addStabilityStudy(CLI::App& study, Action& action);

}  // namespace app
