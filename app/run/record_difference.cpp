// What two runs differ in, in the words of the command line where there is one.
#include <fmt/format.h>

#include "app/run/run_record.h"

namespace app {

namespace {

struct Known {
  const char *path, *word;
};
constexpr Known kKnown[] = {{"program.hash", "the program's hash"},
                            {"scene.text_hash", "the scene's hash"},
                            {"scene.overrides", "--set"},
                            {"picture.width", "--size, width"},
                            {"picture.height", "--size, height"},
                            {"picture.quality", "--quality"},
                            {"picture.hud", "--hud"},
                            {"picture.overlays", "--overlays"},
                            {"picture.print_width", "--print-width"},
                            {"picture.trusted_until", "--trust, until"}};
// What the scene's text and --set say already.
constexpr const char* kFollows[] = {"scene.title", "scene.description", "scene.effects",
                                    "picture.asked_overlays"};

std::string wordOf(const std::string& path) {
  for (const Known& known : kKnown) {
    if (path == known.path) return known.word;
  }
  return path;
}

std::string shown(const Json& value) {
  if (value.is_null()) return "none";
  return jsonText(value);
}

void compareJson(const std::string& path, const Json& was, const Json& is,
                 std::vector<std::string>& differences) {
  if (was == is) return;
  for (const char* follows : kFollows) {
    if (path == follows) return;
  }
  if (!was.is_object() || !is.is_object()) {
    differences.push_back(fmt::format("{}: {} -> {}", wordOf(path), shown(was), shown(is)));
    return;
  }
  for (const auto& [key, value] : was.items()) {
    compareJson(path + "." + key, value, is.value(key, Json()), differences);
  }
  for (const auto& [key, value] : is.items()) {
    if (!was.contains(key)) compareJson(path + "." + key, Json(), value, differences);
  }
}

}  // namespace

std::vector<std::string> differencesOf(const RunRecord& was, const RunRecord& is) {
  std::vector<std::string> differences;
  compareJson("scene", was.scene, is.scene, differences);
  compareJson("settings", was.settings, is.settings, differences);
  compareJson("picture", was.picture, is.picture, differences);
  compareJson("program", was.program, is.program, differences);
  return differences;
}

}  // namespace app
