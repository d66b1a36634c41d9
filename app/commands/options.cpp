// The options that commands share.
#include "app/commands/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <thread>

#include "app/base/shell.h"
#include "app/run/recorded_run.h"
#include "app/take/take_files.h"

namespace app {

namespace {

constexpr int kMostThreads = 256;

}  // namespace

scenes::Scene CommonOptions::readScene() const {
  if (namesRecord(scene)) return recordedScene(openRecord(scene), overrides);
  return scenes::readScene(scene, overrides);
}

std::filesystem::path CommonOptions::outputFolder(const std::string& name) const {
  return folder.empty() ? std::filesystem::path("out") / name : std::filesystem::path(folder);
}

int CommonOptions::threadCount() const {
  if (threads > 0) return threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

ProgressMode CommonOptions::progressMode() const {
  const ProgressMode mode = parseProgressMode(progress);
  return quiet ? ProgressMode::kNone : mode;
}

std::vector<std::string> longNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string given(const CLI::App& command, const std::vector<std::string>& without) {
  std::string text;
  for (const CLI::Option* option : command.parse_order()) {
    const std::string name = option->get_lnames().empty() ? "" : option->get_lnames().front();
    if (std::find(without.begin(), without.end(), name) != without.end()) continue;
    if (text.find(" --" + name + " ") != std::string::npos) continue;  // all its values are there
    const bool isFlag = option->get_items_expected_max() == 0;
    for (const std::string& value : option->results()) {
      if (!option->get_positional()) text += " --" + name;
      if (!isFlag) text += " " + shellQuoted(value);
    }
  }
  return text;
}

std::vector<std::string> wholeLibrary() {
  std::vector<std::string> names = scenes::libraryScenes();
  if (names.empty()) throw scenes::InputError(scenes::nothingIn(scenes::libraryFolder()));
  return names;
}

void requireOwnNames(const std::vector<std::string>& scenes, const std::string& command,
                     const std::filesystem::path& folder, const std::string& advice) {
  std::map<std::string, std::string> taken;
  for (const std::string& scene : scenes) {
    const std::string name = std::filesystem::path(scene).stem().string();
    const auto [before, isNew] = taken.emplace(name, scene);
    if (isNew || before->second == scene) continue;
    throw scenes::InputError(fmt::format("{}: '{}' and '{}' both have the folder {}; {}", command,
                                         before->second, scene, (folder / name).string(), advice));
  }
}

CLI::Option* addScene(CLI::App& command, CommonOptions& options) {
  return command
      .add_option("SCENE", options.scene,
                  "A scene of the library (dbd list), a .toml file, or the run.json of a run")
      ->required();
}

void addCommon(CLI::App& command, CommonOptions& options) {
  addOutput(command, options);
  addOverrides(command, options);
}

void addOverrides(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--set", options.overrides,
                  "Override a value of the scene, as --set contact.friction=0.3; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      .add_option_function<std::string>(
          "--accuracy",
          [&options](const std::string& value) {
            options.overrides.push_back("simulation.accuracy=" + value);
          },
          "How accurately to step, relative to the size of what moves, as 1e-3: "
          "simulation.accuracy")
      ->type_name("A");
}

void addOutput(CLI::App& command, CommonOptions& options, const std::string& folder) {
  command.add_option("-o,--out", options.folder, "Folder for the output [" + folder + "]")
      ->type_name("DIR");
  command.add_option("--threads", options.threads, "Threads [the cores there are]")
      ->check(CLI::Range(1, kMostThreads))
      ->type_name("N");
  command
      .add_option("--progress", options.progress,
                  "Progress on stderr [bar on a terminal, else lines]")
      ->type_name("bar|lines|json|none");
  command.add_flag("--quiet", options.quiet, "No progress and no summary");
}

void addHash(CLI::App& command, CommonOptions& options) {
  command.add_flag("--hash", options.hash, "Print the hash of the last state as the last line");
}

void addTake(CLI::App& command, TakeOptions& options) {
  command
      .add_option("--player", options.player,
                  "A page that plays the motion in 3D in any browser, from disk, all in one file")
      ->type_name("F.html");
  command
      .add_option("--gltf", options.gltf,
                  "The motion as glTF 2.0 with animation, for Blender and other programs")
      ->type_name("F.glb|F.gltf");
}

}  // namespace app
