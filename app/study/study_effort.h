// How much is measured, and what a measurement depends on.
#pragma once

#include <string>
#include <vector>

#include "scenes/study/study_case.h"

namespace app {

struct StudyEffort {
  double repeat = 0.4;  // s of wall time that repeats of a short run may take together
  double longest = 60;  // s that a point may be expected to take
  int mostRepeats = 15;
};
StudyEffort effortOf(bool quick);

std::string joinedLines(const std::vector<std::string>& words);

// Hash of the program, the case, its scene and its reference.
std::string studyInputs(const scenes::StudyCase& study);

}  // namespace app
