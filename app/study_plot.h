// Diagrams of a case by gnuplot: error against time, and error against the step.
#pragma once

#include <filesystem>
#include <string>

#include "app/study_plan.h"

namespace app {

// "gnuplot 5.4 patchlevel 4"; empty: it cannot be run.
std::string gnuplotVersion();

std::string gnuplotHint();  // how to get it

// Writes the script NAME.gp into the folder and runs it there. Throws EnvironmentError with what
// gnuplot said.
void runGnuplot(const std::string& script, const std::filesystem::path& folder,
                const std::string& name);

// Scripts that write NAME.svg, NAME.png and NAME_h.svg, NAME_h.png where they are run.
std::string workPrecisionScript(const StudyResults& results);
std::string convergenceScript(const StudyResults& results);

// Writes the scripts NAME.gp and NAME_h.gp into the folder and runs them there. Throws
// EnvironmentError with what gnuplot said. Nothing where no point is ok.
void drawPlots(const StudyResults& results, const std::filesystem::path& folder);

}  // namespace app
