// Where scenes and assets are found, and a scene by name or path.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenes/scene.h"
#include "scenes/value.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;

// The folder that holds scenes/ and assets/: $DBD_HOME, else beside the program, else the source
// tree.
fs::path home() {
  if (const char* given = std::getenv("DBD_HOME"); given != nullptr && *given != '\0') return given;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (const fs::path& near : {program.parent_path(), program.parent_path() / "../share/dbd"}) {
    if (!error && fs::is_directory(near / "scenes/library", error)) return near;
  }
  return DBD_SOURCE_FOLDER;
}

std::string readText(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    throw InputError(fmt::format("{}: expected a scene file, got a folder", path));
  }
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in) throw InputError(fmt::format("{}: expected a scene file that can be read", path));
  return text.str();
}

bool isPath(const std::string& scene) {
  return scene.find('/') != std::string::npos || scene.ends_with(".toml");
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
  throw InputError(
      fmt::format("no scene '{}' in the library{}", scene, didYouMean(scene, libraryScenes())));
}

}  // namespace

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
  return parseScene(readText(path), path, overrides);
}

}  // namespace scenes
