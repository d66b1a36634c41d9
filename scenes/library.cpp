// Where scenes and assets are found, and a scene by name or path.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "render/shipped.h"
#include "scenes/figure/figure_sheet.h"
#include "scenes/models/read_model.h"
#include "scenes/read/file_text.h"
#include "scenes/read/glossary.h"
#include "scenes/read/recipe.h"
#include "scenes/read/value.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;

// The folder that holds scenes/ and assets/.
fs::path home() {
  if (const char* given = std::getenv("DBD_HOME"); given != nullptr && *given != '\0') return given;
  return render::shippedFolder();
}

// `kind`: "scene" or "figure".
std::string readText(const std::string& path, const char* kind) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    throw InputError(fmt::format("{}: expected a {} file, got a folder", path, kind));
  }
  const std::optional<std::string> text = fileText(path);
  if (!text) throw InputError(fmt::format("{}: expected a {} file that can be read", path, kind));
  return *text;
}

bool isPath(const std::string& scene) {
  return scene.find('/') != std::string::npos || scene.ends_with(".toml") || isModelFile(scene);
}

std::string pathOf(const std::string& scene) {
  std::error_code error;
  if (isPath(scene)) {
    if (fs::exists(scene, error)) return scene;
    throw InputError(fmt::format("{}: no such scene file{}", scene,
                                 didYouMean(fs::path(scene).stem().string(), libraryScenes())));
  }
  const fs::path path = fs::path(libraryFolder()) / (scene + ".toml");
  if (fs::is_regular_file(path, error)) return path.string();
  const std::vector<std::string> known = libraryScenes();
  if (known.empty()) throw InputError(nothingIn(libraryFolder()));
  throw InputError(fmt::format("no scene '{}' in the library{}", scene, didYouMean(scene, known)));
}

// "3", "03", "figure03", "axle" and "03_axle" all name 03_axle.toml.
std::string shippedSheet(const std::string& figure) {
  const std::string word = figure.starts_with("figure") ? figure.substr(6) : figure;
  std::vector<std::string> known;
  for (const std::string& path : figureSheets()) {
    const std::string stem = fs::path(path).stem().string();
    const size_t bar = stem.find('_');
    const std::string number = stem.substr(0, bar);
    const std::string name = bar == std::string::npos ? stem : stem.substr(bar + 1);
    const bool same = word == stem || word == name || word == number || "0" + word == number;
    if (same) return path;
    known.insert(known.end(), {number, name});
  }
  throw InputError(fmt::format("no figure '{}'{}", figure, didYouMean(word, known)));
}

}  // namespace

std::string nothingIn(const std::string& folder) {
  const char* given = std::getenv("DBD_HOME");
  const bool isSet = given != nullptr && *given != '\0';
  return fmt::format(
      "no .toml file in {}; DBD_HOME ({}) names the folder that holds scenes/ and assets/", folder,
      isSet ? given : "not set");
}

std::string libraryFolder() { return (home() / "scenes" / "library").string(); }
std::string assetFolder() { return (home() / "assets").string(); }

std::vector<std::string> libraryScenes() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(libraryFolder(), error)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Scene readScene(const std::string& scene, std::span<const std::string> overrides) {
  const std::string path = pathOf(scene);
  Scene read = parseScene(readText(path, "scene"), path, overrides);
  if (read.content->steps.empty()) {
    throw InputError(
        fmt::format("{}: expected at least one [[body]], or a generator of bodies", path));
  }
  return read;
}

Glossary shippedGlossary() {
  Glossary glossary;
  std::vector<fs::path> paths;
  std::error_code error;
  for (const char* folder : {"words", "library", "studies/scenes", "figures/panels"}) {
    for (const auto& entry : fs::directory_iterator(home() / "scenes" / folder, error)) {
      if (entry.path().extension() == ".toml") paths.push_back(entry.path());
    }
  }
  if (paths.empty()) throw InputError(nothingIn((home() / "scenes").string()));
  std::sort(paths.begin(), paths.end());
  for (const fs::path& path : paths) {
    parseScene(readText(path.string(), "scene"), path.string(), {}, &glossary);
  }
  for (auto& [table, keys] : glossary.tables) {
    for (GlossaryKey& key : keys) {
      const Meaning* meaning = findMeaning(table, key.name);
      if (key.type.empty() && meaning != nullptr) key.type = meaning->type;
    }
  }
  return glossary;
}

std::vector<std::string> figureSheets() {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(home() / "scenes" / "figures", error)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

FigureSheet readFigureSheet(const std::string& figure) {
  const std::string path = isPath(figure) ? figure : shippedSheet(figure);
  return parseFigureSheet(readText(path, "figure"), path);
}

}  // namespace scenes
