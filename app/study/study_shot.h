// What an error looks like: the state that a point ends in, drawn.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/study/study_plan.h"

namespace app {

struct StudyShot {
  std::string file;     // name in the output folder
  std::string caption;  // "cheapest of ours to 1 %: direct, bdf2, h = 0.01 s"
  StudyKey key;
};

// The points worth looking at: the best, the cheapest to 1 % of ours and of the peers, the worst.
std::vector<StudyShot> chooseShots(const StudyResults& results);

// Simulates and draws those whose file is not there, or all where `fresh`. False: interrupted.
bool drawShots(const StudyResults& results, const std::vector<StudyShot>& shots,
               const std::filesystem::path& folder, bool fresh);

}  // namespace app
