// index.html of a study: every case with its diagrams, tables, references and pictures.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/study/study_shot.h"

namespace app {

struct StudyChapter {
  const StudyResults* results = nullptr;
  std::vector<StudyShot> shots;
  bool plotted = false;
  std::string problem;  // why it has no points
};

// The results of those that have points.
std::vector<const StudyResults*> resultsOf(const std::vector<StudyChapter>& chapters);

// index.html and, where a method was asked for accuracies, asked.csv. `command`: what made it.
std::filesystem::path writeStudyPage(const std::vector<StudyChapter>& chapters,
                                     const std::string& command,
                                     const std::filesystem::path& folder);

}  // namespace app
