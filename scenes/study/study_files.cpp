// Folders and files of studies.
#include "scenes/study/study_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scenes/read/file_text.h"
#include "scenes/read/value.h"
#include "scenes/scene.h"

namespace scenes {

namespace fs = std::filesystem;

std::string studyFolder() { return (fs::path(libraryFolder()).parent_path() / "studies").string(); }

std::string referenceFolder() {
  return (fs::path(assetFolder()).parent_path() / "tests" / "reference").string();
}

std::string readStudyText(const std::string& path) {
  const std::optional<std::string> text = fileText(path);
  if (!text) throw InputError(fmt::format("{}: expected a file that can be read", path));
  return *text;
}

std::vector<std::string> studyFiles(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(studyFolder()) / folder, error)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  }
  if (paths.empty()) throw InputError(nothingIn((fs::path(studyFolder()) / folder).string()));
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string studyPath(const std::string& study, const std::string& folder) {
  std::error_code error;
  const bool isPath = study.find('/') != std::string::npos || study.ends_with(".toml");
  if (isPath) {
    if (fs::is_regular_file(study, error)) return study;
    throw InputError(fmt::format("{}: no such file", study));
  }
  std::vector<std::string> known;
  for (const std::string& path : studyFiles(folder)) {
    known.push_back(fs::path(path).stem().string());
    if (known.back() == study) return path;
  }
  throw InputError(
      fmt::format("no case '{}' in scenes/studies/{}{}", study, folder, didYouMean(study, known)));
}

std::string besideStudy(const std::string& word, const std::string& from) {
  const bool isPath = word.find('/') != std::string::npos || word.ends_with(".toml");
  return isPath ? (fs::path(from).parent_path() / word).lexically_normal().string() : word;
}

}  // namespace scenes
