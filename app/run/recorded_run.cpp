// Reads the scene that a run.json holds.
#include "app/run/recorded_run.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

// What is asked of it later, and of the right type: it may have been written by hand.
bool isSound(const RunRecord& record) {
  const Json& picture = record.picture;
  try {
    (void)record.scene.value("overrides", std::vector<std::string>());
    if (picture.is_null()) return true;
    (void)picture.value("asked_overlays", std::vector<std::string>());
    return picture.at("width").is_number_integer() && picture.at("height").is_number_integer() &&
           picture.at("quality").is_string() && picture.at("hud").is_boolean() &&
           picture.value("print_width", 0.0) >= 0 && picture.value("trusted_until", 0.0) >= 0;
  } catch (const Json::exception&) {
    return false;
  }
}

}  // namespace

bool namesRecord(const std::string& scene) { return scene.ends_with(".json"); }

RunRecord openRecord(const std::string& file) {
  if (!std::filesystem::exists(file)) throw scenes::InputError(file + ": no such file");
  std::optional<RunRecord> record = readRecordFile(file);
  if (!record || !isSound(*record))
    throw scenes::InputError(file + ": it is no run.json of dbd render or dbd simulate");
  if (record->sceneText.empty()) {
    throw scenes::InputError(file +
                             ": it holds no scene_text; name the scene instead, or run it again");
  }
  return *record;
}

// What the record overrode is in its text already.
scenes::Scene recordedScene(const RunRecord& record, const std::vector<std::string>& overrides) {
  scenes::Scene scene = scenes::parseScene(record.sceneText, record.scenePath, overrides);
  const auto before = record.scene.value("overrides", std::vector<std::string>());
  scene.overrides.insert(scene.overrides.begin(), before.begin(), before.end());
  return scene;
}

}  // namespace app
