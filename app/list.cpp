// dbd list: the scenes there are.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.h"
#include "app/console.h"
#include "app/run_record.h"

namespace app {

namespace {

struct ListOptions {
  bool json = false;
};

std::string asJson(const std::vector<scenes::Scene>& library) {
  Json list = Json::array();
  for (const scenes::Scene& scene : library) {
    list.push_back({{"name", scene.name},
                    {"title", scene.title},
                    {"description", scene.description},
                    {"duration", scene.duration},
                    {"fps", scene.fps},
                    {"effects", scene.effects},
                    {"path", scene.path}});
  }
  return list.dump(2) + "\n";
}

std::string asTable(const std::vector<scenes::Scene>& library) {
  std::string table;
  for (const scenes::Scene& scene : library) {
    table +=
        fmt::format("{:<18}{:<48}{}\n", scene.name, scene.title, fmt::join(scene.effects, " "));
  }
  return table;
}

ExitCode list(const ListOptions& options) {
  std::vector<scenes::Scene> library;
  std::string firstError;
  for (const std::string& name : scenes::libraryScenes()) {
    try {
      library.push_back(scenes::readScene(name));
    } catch (const scenes::InputError& error) {
      if (firstError.empty()) firstError = error.what();
    }
  }
  say(options.json ? asJson(library) : asTable(library));
  if (!firstError.empty()) throw scenes::InputError(firstError);
  return ExitCode::kDone;
}

}  // namespace

void addList(CLI::App& line, Action& action) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command = line.add_subcommand("list", "Scenes with their titles and effects");
  command->add_flag("--json", options->json, "As JSON, with descriptions and paths");
  command->callback([options, &action] { action = [options] { return list(*options); }; });
}

}  // namespace app
