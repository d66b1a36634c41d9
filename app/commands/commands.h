// The commands of dbd, one file each.
#pragma once

#include "app/commands/options.h"

namespace app {

// Each adds its command to the line; `action` becomes what to do when the user chose it.
void addList(CLI::App& line, Action& action);
void addPlan(CLI::App& line, Action& action);
void addSimulate(CLI::App& line, Action& action);
void addRender(CLI::App& line, Action& action);
void addRace(CLI::App& line, Action& action);
void addGolden(CLI::App& line, Action& action);
void addCompare(CLI::App& line, Action& action);
void addCheck(CLI::App& line, Action& action);
void addDoctor(CLI::App& line, Action& action);
void addFigures(CLI::App& line, Action& action);
void addGallery(CLI::App& line, Action& action);
void addConvert(CLI::App& line, Action& action);
void addDiverge(CLI::App& line, Action& action);
void addTrust(CLI::App& line, Action& action);
void addWords(CLI::App& line, Action& action);
void addStudy(CLI::App& line, Action& action);
// Of all commands that the line has: the last to be added.
void addCompletion(CLI::App& line, Action& action);

}  // namespace app
