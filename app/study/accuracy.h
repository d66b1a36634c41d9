// The accuracy study: what its cases are compared with, how a point is measured, and what they all
// say together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/results.h"
#include "app/study/store.h"
#include "app/study/study.h"

namespace app {

struct StudyTruth {
  scenes::StudyTrace trace;
  CaseReference report;
};

// Hash of the program, the case, its scene and its reference.
std::string inputsOf(const scenes::StudyCase& study);

// The case's table and laws, or a fine run of its own beside one with half as many substeps, whose
// samples the store keeps. None: interrupted. Throws InputError where it cannot be had.
std::optional<StudyTruth> findTruth(const scenes::StudyCase& study, const std::string& inputs,
                                    Store& store);

// The run of a point.
Run runOf(const scenes::StudyCase& study, const scenes::StudyMethod& method,
          const scenes::StudyGrid& grid, const RunKey& key);

struct PointEffort {
  RunEffort repeats;
  double longest = 60;  // s that a point may be expected to take
};
PointEffort effortOf(bool quick);

// Measures a run against the truth, and times it again where it is short. None: interrupted.
std::optional<Trace> measurePoint(const scenes::StudyCase& study, const Run& run,
                                  const scenes::StudyTrace& truth, const PointEffort& effort);

// The report of what was measured; pictures are drawn into the folder. None: interrupted.
std::optional<StudyFindings> accuracyFindings(const std::vector<const CaseResults*>& cases,
                                              const std::string& command,
                                              const std::filesystem::path& folder);

// Accuracy asked for across, time for a simulated second up: a line for each kind of scene, and
// where the best of the other engines is. Empty: nothing was asked for an accuracy.
struct Glance {
  std::optional<Chart> chart;
  std::vector<std::string> sentences;  // "Joints (14 cases): ten times more accurate costs ..."
};
Glance glanceAt(const std::vector<const CaseResults*>& cases);

// Error against time, and against the step, of a case; the second is none where nothing has steps.
Chart timeChart(const CaseResults& results);
std::optional<Chart> stepChart(const CaseResults& results);

}  // namespace app
