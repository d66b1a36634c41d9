// Diagrams of a case by gnuplot: error against time, and error against the step.
#pragma once

#include <filesystem>
#include <string>

#include "app/study/study_plan.h"

namespace app {

// Scripts that write NAME.svg, NAME.png and NAME_h.svg, NAME_h.png where they are run.
std::string workPrecisionScript(const StudyResults& results);
std::string convergenceScript(const StudyResults& results);

// Writes the scripts NAME.gp and NAME_h.gp into the folder and runs them there. Throws
// EnvironmentError with what gnuplot said. Nothing where no point is ok; what has no step is not
// in NAME_h.
void drawPlots(const StudyResults& results, const std::filesystem::path& folder);

}  // namespace app
