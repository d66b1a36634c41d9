// The options that commands share.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/base/progress.h"
#include "app/commands/exit_code.h"
#include "scenes/scene.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace app {

struct TakeOptions;

using Action = std::function<ExitCode()>;  // what the chosen command does

struct CommonOptions {
  std::string scene;
  std::string folder;  // -o; empty: out/NAME
  int threads = 0;     // 0: the cores there are
  std::vector<std::string> overrides;
  std::string progress;
  bool quiet = false;
  bool hash = false;

  scenes::Scene readScene() const;
  std::filesystem::path outputFolder(const std::string& name) const;
  int threadCount() const;
  ProgressMode progressMode() const;
};

// "--video" and the others of one command.
std::vector<std::string> longNames(const CLI::App& command);

// What was given to a command, quoted for a shell: " dominoes --size 640x360 --hud", without the
// options of these names.
std::string given(const CLI::App& command, const std::vector<std::string>& without);

// Every scene of the library; throws InputError where there is none.
std::vector<std::string> wholeLibrary();

// Where each of these scenes has a folder of its name: throws InputError where two are of one name,
// "COMMAND: 'a' and 'b' both have the folder FOLDER/NAME; ADVICE".
void requireOwnNames(const std::vector<std::string>& scenes, const std::string& command,
                     const std::filesystem::path& folder, const std::string& advice);

CLI::Option* addScene(CLI::App& command, CommonOptions& options);  // required
// -o --threads --progress --quiet; `folder` says what -o is without being given.
void addOutput(CLI::App& command, CommonOptions& options, const std::string& folder = "out/NAME");
void addOverrides(CLI::App& command, CommonOptions& options);  // --set
void addCommon(CLI::App& command, CommonOptions& options);     // these and --set
void addHash(CLI::App& command, CommonOptions& options);
void addTake(CLI::App& command, TakeOptions& options);  // --player --gltf

}  // namespace app
