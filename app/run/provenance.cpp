// Texts from a run's record.
#include "app/run/provenance.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/shell.h"
#include "scenes/joined.h"

namespace app {

namespace {

std::string program(const RunRecord& record) {
  return "dbd " + record.program.value("version", std::string());
}

std::string sceneAndHash(const RunRecord& record) {
  return fmt::format("{} {}", record.scene.value("source", std::string()),
                     record.scene.value("text_hash", std::string()));
}

}  // namespace

std::string commandOf(const std::string& word, const RunRecord& record) {
  std::string line = "dbd " + word + " " + shellQuoted(record.scene.value("source", std::string()));
  for (const Json& setting : record.scene.value("overrides", Json::array())) {
    line += " --set " + shellQuoted(setting.get<std::string>());
  }
  return line;
}

std::string commandOf(const RunRecord& record, const std::string& frames) {
  const Json& picture = record.picture;
  std::string line = commandOf("render", record);
  line += fmt::format(" --quality {} --size {}x{}", picture.value("quality", std::string()),
                      picture.value("width", 0), picture.value("height", 0));
  const auto overlays = picture.value("asked_overlays", std::vector<std::string>());
  if (!overlays.empty()) line += fmt::format(" --overlays {}", scenes::joined(overlays, ","));
  if (picture.contains("print_width")) {
    line += fmt::format(" --print-width {}", picture.value("print_width", 0.0));
  }
  if (picture.contains("trusted_until")) {
    line += " --trust";
  } else if (picture.value("hud", false)) {
    line += " --hud";
  }
  return frames.empty() ? line : line + " --frames " + frames;
}

render::PngNotes notesOf(const RunRecord& record, int frame) {
  return notesOf(record, frame, commandOf(record, fmt::format("{}", frame)));
}

render::PngNotes notesOf(const RunRecord& record, int frame, const std::string& command) {
  const int fps = std::max(1, record.settings.value("fps", 1));
  render::PngNotes notes;
  notes.texts = {{"Title", record.scene.value("title", std::string())},
                 {"Software", program(record)},
                 {"Scene", sceneAndHash(record)},
                 {"Frame", fmt::format("{}", frame)},
                 {"Time", fmt::format("{:.6g} s", static_cast<double>(frame) / fps)},
                 {"Command", command}};
  if (record.picture.is_object()) {
    notes.printedWidth = record.picture.value("print_width", 0.0) / 100;
  }
  return notes;
}

std::vector<std::array<std::string, 2>> filmNotes(const RunRecord& record) {
  return {{"title", record.scene.value("title", std::string())},
          {"comment",
           fmt::format("{}; {}; scene {}", program(record),
                       commandOf(record, record.frames) + " --video", sceneAndHash(record))}};
}

}  // namespace app
