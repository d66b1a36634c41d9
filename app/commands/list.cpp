// dbd list: the scenes and the figures there are.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/commands/commands.h"
#include "app/run/run_record.h"
#include "scenes/figure/figure_sheet.h"
#include "scenes/joined.h"

namespace app {

namespace {

struct ListOptions {
  bool json = false;
};

std::string asJson(const std::vector<scenes::Scene>& library,
                   const std::vector<scenes::FigureSheet>& figures) {
  Json list = Json::array();
  for (const scenes::Scene& scene : library) {
    list.push_back({{"kind", "scene"},
                    {"name", scene.name},
                    {"title", scene.title},
                    {"description", scene.description},
                    {"duration", scene.duration},
                    {"fps", scene.fps},
                    {"effects", scene.effects},
                    {"path", scene.path}});
  }
  for (const scenes::FigureSheet& figure : figures) {
    list.push_back({{"kind", "figure"},
                    {"name", figure.name},
                    {"title", figure.title},
                    {"claim", figure.claim},
                    {"path", figure.path}});
  }
  return jsonText(list, 2) + "\n";
}

std::string asTable(const std::vector<scenes::Scene>& library,
                    const std::vector<scenes::FigureSheet>& figures) {
  std::string table;
  for (const scenes::Scene& scene : library) {
    table += fmt::format("{:<18}{:<48}{}\n", scene.name, scene.title,
                         scenes::joined(scene.effects, " "));
  }
  for (const scenes::FigureSheet& figure : figures) {
    table += fmt::format("{:<18}{}\n", figure.name, figure.title);
  }
  return table;
}

// What can be read of them; the first that cannot is told in the end.
template <class Read>
auto readAll(const std::vector<std::string>& names, Read read, std::string& firstError) {
  std::vector<decltype(read(std::string()))> all;
  for (const std::string& name : names) {
    try {
      all.push_back(read(name));
    } catch (const scenes::InputError& error) {
      if (firstError.empty()) firstError = error.what();
    }
  }
  return all;
}

ExitCode list(const ListOptions& options) {
  std::string firstError;
  const auto library = readAll(
      wholeLibrary(), [](const std::string& name) { return scenes::readScene(name); }, firstError);
  const auto figures = readAll(
      scenes::figureSheets(), [](const std::string& path) { return scenes::readFigureSheet(path); },
      firstError);
  say(options.json ? asJson(library, figures) : asTable(library, figures));
  if (!firstError.empty()) throw scenes::InputError(firstError);
  return ExitCode::kDone;
}

}  // namespace

void addList(CLI::App& line, Action& action) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command =
      line.add_subcommand("list", "Scenes with their titles and effects, and figures");
  command->add_flag("--json", options->json, "As JSON, with descriptions and paths");
  command->callback([options, &action] { action = [options] { return list(*options); }; });
}

}  // namespace app
