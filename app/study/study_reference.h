// What a case is compared with: its table and laws, or a fine run of its own, which is kept in the
// output folder.
#pragma once

#include <filesystem>
#include <optional>

#include "app/study/study_plan.h"
#include "scenes/study/study_trace.h"

namespace app {

struct StudyTruth {
  scenes::StudyTrace trace;
  StudyReferenceReport report;
};

// Runs the reference and the one with half as many substeps at the same time, unless the folder has
// them for the same `inputs`. None: interrupted. Throws InputError where the reference run fails.
std::optional<StudyTruth> findTruth(const scenes::StudyCase& study, const std::string& inputs,
                                    const std::filesystem::path& folder);

// Traces as text, for the file.
std::string traceText(const scenes::StudyTrace& trace);
std::optional<scenes::StudyTrace> parseTrace(const std::string& text, std::size_t quantities,
                                             int samples);

}  // namespace app
