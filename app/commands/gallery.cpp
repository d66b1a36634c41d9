// dbd gallery: one page that shows what was rendered into the folders beside it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/base/html.h"
#include "app/base/output_file.h"
#include "app/commands/commands.h"
#include "app/figure/figure_record.h"
#include "app/run/run_page.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct GalleryOptions {
  std::string folder;
  std::vector<std::string> names;
};

std::vector<fs::path> chosenFolders(const GalleryOptions& options) {
  if (options.names.empty()) return runFolders(options.folder);
  std::vector<fs::path> folders;
  for (const std::string& name : options.names) folders.push_back(fs::path(options.folder) / name);
  return folders;
}

ExitCode gallery(const GalleryOptions& options) {
  if (!fs::is_directory(options.folder)) {
    throw scenes::InputError("gallery: no folder " + options.folder);
  }
  if (options.names.empty() && holdsParts(options.folder)) {
    say(writeFigurePage(options.folder).string() + "\n");
    return ExitCode::kDone;
  }
  const std::string runs = showRuns(chosenFolders(options), "");
  if (runs.empty()) throw scenes::InputError("gallery: nothing was rendered in " + options.folder);
  const std::string body =
      "<h1>Displacement based dynamics</h1>\n<p class=\"quiet\">Scenes that dbd simulated and drew "
      "on "
      "this machine. What each scene expects of itself was checked along its whole run.</p>\n" +
      runs;
  const fs::path page = fs::path(options.folder) / "index.html";
  writeFile(page, htmlPage("Displacement based dynamics", body));
  say(page.string() + "\n");
  return ExitCode::kDone;
}

}  // namespace

void addGallery(CLI::App& line, Action& action) {
  auto options = std::make_shared<GalleryOptions>();
  CLI::App* command = line.add_subcommand(
      "gallery",
      "Write DIR/index.html that shows what was rendered into DIR/NAME, or the films, figures and "
      "studies that are in DIR");
  command->add_option("DIR", options->folder, "Folder of rendered folders")->required();
  command->add_option("NAME", options->names, "Which, and in this order [all]");
  command->callback([options, &action] { action = [options] { return gallery(*options); }; });
}

}  // namespace app
