// Rendered scenes as parts of a page.
#include "app/run/run_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/base/html.h"
#include "app/run/run_record.h"

namespace app {

namespace {

namespace fs = std::filesystem;

std::string fieldText(const Json& json, const char* key) {
  return json.is_object() ? escapeHtml(json.value(key, "")) : "";
}

// The frame in the middle of what was drawn: something is moving there.
std::string posterOf(const fs::path& folder, const std::string& link) {
  std::set<std::string> frames;
  if (fs::is_directory(folder / "frames")) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "frames")) {
      if (entry.path().extension() == ".png") frames.insert(entry.path().filename().string());
    }
  }
  if (frames.empty()) return "";
  return link + "/frames/" + *std::next(frames.begin(), static_cast<long>(frames.size() / 2));
}

std::string showPicture(const RunRecord& record, const std::string& poster,
                        const std::string& link) {
  const std::string still = escapeHtml(poster);
  if (!record.video.is_object()) {
    return still.empty() ? "" : fmt::format("<img class=\"poster\" src=\"{}\" alt=\"\">\n", still);
  }
  return fmt::format(
      "<video controls loop muted playsinline preload=\"metadata\" poster=\"{}\" src=\"{}/{}\" "
      "width=\"{}\" height=\"{}\"></video>\n",
      still, escapeHtml(link), fieldText(record.video, "file"), record.picture.value("width", 0),
      record.picture.value("height", 0));
}

std::string showExpectations(const RunRecord& record) {
  if (record.expectations.empty()) return "<p class=\"quiet\">No expectations were checked.</p>\n";
  std::string html = "<table><tr><th></th><th>expected of the whole run</th><th>at</th></tr>\n";
  for (const Json& verdict : record.expectations) {
    const bool holds = verdict.value("holds", false);
    html += fmt::format(
        "<tr><td class=\"{}\">{}</td><td>{}</td><td class=\"number\">{:.2f} s</td></tr>\n",
        holds ? "good" : "bad", holds ? "holds" : "fails", fieldText(verdict, "text"),
        verdict.value("at_time", 0.0));
  }
  return html + "</table>\n";
}

std::string showTimes(const RunRecord& record) {
  const double frames = static_cast<double>(std::max<std::size_t>(1, record.stateHashes.size()));
  std::string html = "<table><tr><th>time spent</th><th></th><th>per frame</th></tr>\n";
  for (const char* stage : {"camera", "simulate", "view", "draw", "write", "film", "wall"}) {
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

std::string substepsOf(const Json& settings) {
  const auto found = settings.find("substeps");
  const bool isCount = found != settings.end() && found->is_number();
  return isCount ? fmt::format("{} substeps", found->get<int>()) : "substeps as each island asks";
}

std::string showSettings(const RunRecord& record) {
  const Json& s = record.settings;
  return fmt::format(
      "<p class=\"quiet\">{} frames at {} per second, {}, {} iterations, {}×{} pixels, {} "
      "quality. Last state <code>{}</code></p>\n",
      s.value("frames", 0), s.value("fps", 0), substepsOf(s), s.value("iterations", 0),
      record.picture.value("width", 0), record.picture.value("height", 0),
      fieldText(record.picture, "quality"),
      record.stateHashes.empty() ? "" : record.stateHashes.back());
}

std::string showRun(const RunRecord& record, const fs::path& folder, const std::string& link) {
  std::string html = fmt::format("<section><h2>{}</h2>\n", fieldText(record.scene, "title"));
  const std::string description = fieldText(record.scene, "description");
  if (!description.empty()) html += fmt::format("<p>{}</p>\n", description);
  html += "<div class=\"sides\"><div>\n" + showPicture(record, posterOf(folder, link), link);
  html += fmt::format("</div><div>\n{}{}{}", showExpectations(record), showTimes(record),
                      showSettings(record));
  html += fmt::format("<p><code>dbd render {}{}</code></p>\n", fieldText(record.scene, "name"),
                      record.video.is_object() ? " --video" : "");
  return html + "</div></div></section>\n";
}

}  // namespace

std::vector<fs::path> runFolders(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::string showRuns(std::span<const fs::path> folders, const std::string& prefix) {
  std::string html;
  for (const fs::path& folder : folders) {
    const std::optional<RunRecord> record = readRecord(folder);
    if (!record || !record->picture.is_object()) continue;
    html += showRun(*record, folder, prefix + folder.filename().string());
  }
  return html;
}

}  // namespace app
