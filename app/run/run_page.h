// Rendered scenes as parts of a page: film, expectations, times.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace app {

// The folders in `folder`, sorted: those that may hold a run.
std::vector<std::filesystem::path> runFolders(const std::filesystem::path& folder);

// A section for each folder that holds a rendered run; files are linked as prefix + folder's name.
// Empty where there is none.
std::string showRuns(std::span<const std::filesystem::path> folders, const std::string& prefix);

}  // namespace app
