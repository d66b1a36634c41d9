// dbd compare: two images, or the PNG files of two folders.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <set>

#include "app/base/console.h"
#include "app/base/image_report.h"
#include "app/commands/commands.h"
#include "render/png.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::string a, b, folder;
  bool exact = false, quiet = false;
};

// Empty when there is no such file.
render::Image readImage(const fs::path& file) {
  if (!fs::exists(file)) return {};
  try {
    return render::readPng(file);
  } catch (const std::system_error&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw scenes::InputError(error.what());
  }
}

std::set<fs::path> pngFiles(const fs::path& folder) {
  std::set<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".png") files.insert(fs::relative(entry.path(), folder));
  }
  return files;
}

std::vector<ImagePair> compareFolders(const fs::path& a, const fs::path& b) {
  std::set<fs::path> files = pngFiles(a);
  files.merge(pngFiles(b));
  if (files.empty()) {
    throw scenes::InputError(fmt::format("compare: no PNG in {} and {}", a.string(), b.string()));
  }
  std::vector<ImagePair> pairs;
  for (const fs::path& file : files) {
    ImagePair pair = comparePair(file.string(), readImage(a / file), readImage(b / file));
    if (pair.passed) pair.want = pair.got = {};  // only differences are shown
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

std::vector<ImagePair> comparePaths(const fs::path& a, const fs::path& b) {
  for (const fs::path& path : {a, b}) {
    if (!fs::exists(path)) throw scenes::InputError("compare: no file or folder " + path.string());
  }
  if (fs::is_directory(a) != fs::is_directory(b)) {
    throw scenes::InputError("compare: expected two images or two folders");
  }
  if (fs::is_directory(a)) return compareFolders(a, b);
  std::vector<ImagePair> pairs;
  pairs.push_back(comparePair(b.filename().string(), readImage(a), readImage(b)));
  return pairs;
}

std::string numbers(const ImagePair& pair) {
  const render::Comparison& c = pair.comparison;
  if (c.pixels == 0) return "";
  return fmt::format(
      "      pixels {}, visible {}, strong {}, largest {} levels, worst tile {} at {},{}\n",
      c.pixels, c.visible, c.strong, c.largest, c.worstTile, c.worstTileX, c.worstTileY);
}

ExitCode compare(const CompareOptions& options) {
  std::vector<ImagePair> pairs = comparePaths(options.a, options.b);
  std::size_t failed = 0;
  for (ImagePair& pair : pairs) {
    if (options.exact && !pair.comparison.identical) pair.passed = false;
    if (!pair.passed) ++failed;
    if (!options.quiet) say(describePair(pair) + numbers(pair));
  }
  if (!options.quiet) say(fmt::format("{} of {} images differ\n", failed, pairs.size()));
  if (!options.folder.empty()) {
    const fs::path page = writeImageReport("Comparison", pairs, options.folder);
    if (!options.quiet) say(page.string() + "\n");
  }
  return failed == 0 ? ExitCode::kDone : ExitCode::kCheckFailed;
}

}  // namespace

void addCompare(CLI::App& line, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = line.add_subcommand(
      "compare", "Compare two images or two folders of them; exit code 3 when they differ");
  command->add_option("A", options->a, "What is wanted: a PNG, or a folder")->required();
  command->add_option("B", options->b, "What there is")->required();
  command->add_flag("--exact", options->exact, "Every pixel equal, instead of the golden budget");
  command->add_option("-o,--out", options->folder, "Write an HTML report of the differences")
      ->type_name("DIR");
  command->add_flag("--quiet", options->quiet, "Only the exit code");
  command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace app
