// Measuring what single choices buy: the same cases with and without each.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/study/study_plan.h"
#include "scenes/study/study_option.h"

namespace app {

struct TrialResult {
  std::string title, step;  // of the case; "h = 0.01 s, 4 substeps"
  std::string unit;
  std::string problem;  // why there is no reference; empty: none
  StudyPoint with, without;
};

struct OptionResult {
  scenes::StudyOption option;
  std::vector<TrialResult> trials;
};

// Measures one trial both ways. What `store` has is not measured again. None: interrupted.
std::optional<TrialResult> measureTrial(const scenes::StudyOption& option, int trial, bool quick,
                                        PointStore& store, const std::filesystem::path& folder);

std::string optionText(const OptionResult& result);     // for standard output
std::string optionSection(const OptionResult& result);  // HTML

}  // namespace app
