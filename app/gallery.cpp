// dbd gallery: one page that shows what was rendered into the folders beside it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <set>

#include "app/commands.h"
#include "app/console.h"
#include "app/frame_folder.h"
#include "app/html.h"
#include "app/output_file.h"
#include "app/run_record.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct GalleryOptions {
  std::string folder;
  std::vector<std::string> names;
};

std::string textOf(const Json& json, const char* key) {
  return json.is_object() ? escapeHtml(json.value(key, "")) : "";
}

// The frame in the middle of what was drawn: something is moving there.
std::string posterOf(const fs::path& folder, const std::string& name) {
  std::set<std::string> frames;
  if (fs::is_directory(folder / "frames")) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "frames")) {
      if (entry.path().extension() == ".png") frames.insert(entry.path().filename().string());
    }
  }
  if (frames.empty()) return "";
  return name + "/frames/" + *std::next(frames.begin(), static_cast<long>(frames.size() / 2));
}

std::string showPicture(const RunRecord& record, const std::string& poster,
                        const std::string& name) {
  const std::string still = escapeHtml(poster);
  if (!record.video.is_object()) {
    return still.empty() ? "" : fmt::format("<img class=\"poster\" src=\"{}\" alt=\"\">\n", still);
  }
  return fmt::format(
      "<video controls loop muted playsinline preload=\"metadata\" poster=\"{}\" src=\"{}/{}\" "
      "width=\"{}\" height=\"{}\"></video>\n",
      still, escapeHtml(name), textOf(record.video, "file"), record.picture.value("width", 0),
      record.picture.value("height", 0));
}

std::string showExpectations(const RunRecord& record) {
  if (record.expectations.empty()) return "<p class=\"quiet\">No expectations were checked.</p>\n";
  std::string html = "<table><tr><th></th><th>expected of the whole run</th><th>at</th></tr>\n";
  for (const Json& verdict : record.expectations) {
    const bool holds = verdict.value("holds", false);
    html += fmt::format(
        "<tr><td class=\"{}\">{}</td><td>{}</td><td class=\"number\">{:.2f} s</td></tr>\n",
        holds ? "good" : "bad", holds ? "holds" : "fails", textOf(verdict, "text"),
        verdict.value("at_time", 0.0));
  }
  return html + "</table>\n";
}

std::string showTimes(const RunRecord& record) {
  const double frames = static_cast<double>(std::max<std::size_t>(1, record.stateHashes.size()));
  std::string html = "<table><tr><th>time spent</th><th></th><th>per frame</th></tr>\n";
  for (const char* stage : {"simulate", "view", "draw", "write", "film", "wall"}) {
    if (!record.seconds.contains(stage)) continue;
    const double seconds = record.seconds.value(stage, 0.0);
    html += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{:.2f} s</td><td class=\"number\">{:.2f} "
        "ms</td></tr>\n",
        stage == std::string("wall") ? "in all, without film" : stage, seconds,
        1e3 * seconds / frames);
  }
  return html + "</table>\n";
}

std::string showSettings(const RunRecord& record) {
  const Json& s = record.settings;
  return fmt::format(
      "<p class=\"quiet\">{} frames at {} per second, {} substeps, {} iterations, {}×{} pixels, {} "
      "quality. Last state <code>{}</code></p>\n",
      s.value("frames", 0), s.value("fps", 0), s.value("substeps", 0), s.value("iterations", 0),
      record.picture.value("width", 0), record.picture.value("height", 0),
      textOf(record.picture, "quality"),
      record.stateHashes.empty() ? "" : record.stateHashes.back());
}

std::string showRun(const RunRecord& record, const fs::path& folder) {
  const std::string name = folder.filename().string();
  std::string html = fmt::format("<section><h2>{}</h2>\n", textOf(record.scene, "title"));
  const std::string description = textOf(record.scene, "description");
  if (!description.empty()) html += fmt::format("<p>{}</p>\n", description);
  html += "<div class=\"sides\"><div>\n" + showPicture(record, posterOf(folder, name), name);
  html += fmt::format("</div><div>\n{}{}{}", showExpectations(record), showTimes(record),
                      showSettings(record));
  html += fmt::format("<p><code>dbd render {}{}</code></p>\n", textOf(record.scene, "name"),
                      record.video.is_object() ? " --video" : "");
  return html + "</div></div></section>\n";
}

std::vector<fs::path> runFolders(const GalleryOptions& options) {
  std::vector<fs::path> folders;
  for (const std::string& name : options.names) folders.push_back(fs::path(options.folder) / name);
  if (!options.names.empty()) return folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(options.folder)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

ExitCode gallery(const GalleryOptions& options) {
  if (!fs::is_directory(options.folder)) {
    throw scenes::InputError("gallery: no folder " + options.folder);
  }
  std::string runs;
  int count = 0;
  for (const fs::path& folder : runFolders(options)) {
    const std::optional<RunRecord> record = readRecord(folder);
    if (!record || !record->picture.is_object()) continue;
    runs += showRun(*record, folder);
    ++count;
  }
  if (count == 0) throw scenes::InputError("gallery: nothing was rendered in " + options.folder);
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
      "gallery", "Write DIR/index.html that shows what was rendered into DIR/NAME");
  command->add_option("DIR", options->folder, "Folder of rendered folders")->required();
  command->add_option("NAME", options->names, "Which, and in this order [all]");
  command->callback([options, &action] { action = [options] { return gallery(*options); }; });
}

}  // namespace app
