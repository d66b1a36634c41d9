// What `dbd study stability` says and writes: lines, tables, and index.html.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/study/stability_study.h"

namespace app {

// The verdict of a case with every number, and where it fails what is known of the failure.
std::string verdictText(const StabilityResult& result);

// The borders that were found; empty where none was looked for.
std::string severityText(const StabilityResult& result);

// cases.csv: a row for each expectation of each case. severity.csv: one for each case and method.
std::string casesTable(const std::vector<StabilityResult>& results);
std::string severityTable(const std::vector<StabilityResult>& results);

// The families that have cases, in the order of their file.
std::vector<scenes::StabilityFamily> familiesOf(const std::vector<StabilityResult>& results);
std::vector<const StabilityResult*> casesOf(const std::vector<StabilityResult>& results,
                                            const std::string& family);

// `command`: what made it. Maps are shown where FOLDER/map_FAMILY.svg is.
std::filesystem::path writeStabilityPage(const std::vector<StabilityResult>& results,
                                         const std::string& command,
                                         const std::filesystem::path& folder);

}  // namespace app
