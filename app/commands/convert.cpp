// dbd convert: a model of other programs (MJCF, URDF) as a scene file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/base/console.h"
#include "app/base/output_file.h"
#include "app/commands/commands.h"
#include "scenes/models/read_model.h"

namespace app {
namespace {

struct ConvertOptions {
  std::string model, file = "-", keyframe;
};

ExitCode convert(const ConvertOptions& options) {
  if (!scenes::isModelFile(options.model)) {
    throw scenes::InputError(
        fmt::format("convert: expected a model, .xml, .mjcf or .urdf, got {}", options.model));
  }
  requireOwnFiles({{"--out", options.file}}, options.model);
  std::vector<std::string> settings;
  if (!options.keyframe.empty()) settings.push_back("keyframe=" + options.keyframe);
  const scenes::Scene scene = scenes::readScene(options.model, settings);
  const std::string name = std::filesystem::path(options.model).filename().string();
  std::string text = fmt::format("# From {}.\n", name);
  for (const std::string& told : scene.told) {
    note(fmt::format("dbd: warning: {}\n", told));
    const bool own = told.starts_with(options.model + ":");
    text += "# " + (own ? name + told.substr(options.model.size()) : told) + "\n";
  }
  OutputFile file(options.file);
  file.write(text + "\n" + scene.text);
  file.commit();
  return ExitCode::kDone;
}

}  // namespace

void addConvert(CLI::App& line, Action& action) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = line.add_subcommand(
      "convert", "A model of other programs as a scene file: MJCF (.xml, .mjcf) and URDF (.urdf)");
  command->add_option("MODEL", options->model, "A file of MuJoCo's or ROS's")->required();
  command->add_option("-o,--out", options->file, "The scene file to write; - is standard output");
  command->add_option("--keyframe", options->keyframe, "The <key> of MJCF that it starts in");
  command->callback([options, &action] { action = [options] { return convert(*options); }; });
}

}  // namespace app
