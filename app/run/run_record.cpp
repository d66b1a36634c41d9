// run.json: what made the files of an output folder, and with which result.
#include "app/run/run_record.h"

#include <fmt/format.h>

#include "app/base/build_info.h"
#include "app/base/console.h"
#include "app/base/output_file.h"
#include "scenes/measure/start_warnings.h"
#include "scenes/read/file_text.h"
#include "scenes/read/settings_reader.h"
#include "scenes/read/write_scene.h"

namespace app {

namespace {

constexpr const char* kFile = "run.json";

Json toJson(const physics::Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json describeContact(const physics::ContactSettings& contact) {
  return {{"friction",
           {{"static", contact.friction.staticCoefficient},
            {"dynamic", contact.friction.dynamicCoefficient}}},
          {"restitution", contact.restitution},
          {"max_separation_speed", contact.maxSeparationSpeed},
          {"margin", contact.margin}};
}

// How a command names it: a scene of the library by its word, another by its file.
std::string sourceOf(const scenes::Scene& scene) {
  const std::filesystem::path path(scene.path);
  std::error_code ignored;
  const bool isShipped =
      std::filesystem::equivalent(path.parent_path(), scenes::libraryFolder(), ignored);
  return isShipped ? scene.name : path.filename().string();
}

Json describeSettings(const scenes::Scene& scene) {
  const physics::Settings& s = scene.settings;
  Json json = {{"duration", scene.duration},
               {"fps", scene.fps},
               {"frames", scene.frameCount()},
               {"seed", scene.seed},
               {"dt", s.dt},
               {"iterations", s.iterations},
               {"method", scenes::wordOf(s.method)},
               {"stepping", scenes::wordOf(s.stepping)},
               {"relaxation", s.relaxation},
               {"regularisation", s.regularisation}};
  json["substeps"] = s.choosesSubsteps() ? Json() : Json(s.substepCount());
  json["accuracy"] = s.accuracy ? Json(*s.accuracy) : Json();
  json["gravity"] = s.gravity ? toJson(*s.gravity) : Json();
  json["contact"] = s.contact ? describeContact(*s.contact) : Json();
  return json;
}

}  // namespace

void RunRecord::addSeconds(const std::string& stage, double more) {
  if (more > 0) seconds[stage] = seconds.value(stage, 0.0) + more;
}

bool RunRecord::sameStates(const RunRecord& other) const {
  return program == other.program && scene == other.scene && settings == other.settings;
}

bool RunRecord::sameFrames(const RunRecord& other) const {
  return sameStates(other) && picture == other.picture;
}

RunRecord makeRecord(const scenes::Scene& scene) {
  RunRecord record;
  record.sceneText = scenes::textOf(scene);
  record.scenePath = std::filesystem::absolute(scene.path).lexically_normal().string();
  record.program = {{"version", version()},
                    {"compiler", compiler()},
                    {"flags", compileFlags()},
                    {"hash", programHash()}};
  record.scene = {{"name", scene.name},
                  {"title", scene.title},
                  {"description", scene.description},
                  {"source", sourceOf(scene)},
                  {"text_hash", hashText(record.sceneText)},
                  {"overrides", scene.overrides},
                  {"effects", scene.effects}};
  record.settings = describeSettings(scene);
  record.warnings = scene.told;
  const std::vector<std::string> odd = scenes::startWarnings(scene);
  record.warnings.insert(record.warnings.end(), odd.begin(), odd.end());
  return record;
}

std::string sceneHash(const scenes::Scene& scene) { return hashText(scenes::textOf(scene)); }

void noteWarnings(const RunRecord& record) {
  noteWarnings(record.scene.value("name", ""), record.warnings);
}

void noteWarnings(const std::string& scene, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    note(fmt::format("dbd: warning: {}: {}\n", scene, warning));
  }
}

Json describePicture(const render::RendererOptions& options, const render::Renderer::Info& info,
                     bool hud, const scenes::Overlays& overlays) {
  Json shown = Json::array();
  if (overlays.contacts) shown.push_back("contacts");
  if (overlays.impulses) shown.push_back("impulses");
  if (overlays.joints) shown.push_back("joints");
  if (overlays.centresOfMass) shown.push_back("masses");
  if (overlays.arms) shown.push_back("arms");
  if (overlays.armTargets) shown.push_back("arm_targets");
  if (overlays.armAngles) shown.push_back("arm_angles");
  if (overlays.armTips) shown.push_back("arm_tips");
  if (overlays.armCentres) shown.push_back("arm_centres");
  if (overlays.vectors) shown.push_back("vectors");
  return {{"width", options.width},
          {"height", options.height},
          {"quality", qualityName(options.quality)},
          {"hud", hud},
          {"overlays", shown},
          {"renderer",
           {{"vendor", info.vendor}, {"renderer", info.renderer}, {"version", info.version}}}};
}

void addAccuracy(const scenes::Scene& scene, const physics::AccuracyReport& frame, Json& accuracy) {
  if (!scene.settings.accuracy) return;
  const auto sum = [&](const char* key, auto more) {
    accuracy[key] = accuracy.value(key, decltype(more){}) + more;
  };
  accuracy["asked"] = *scene.settings.accuracy;
  sum("accepted_steps", frame.accepted);
  sum("rejected_steps", frame.rejected);
  accuracy["order"] = std::max(accuracy.value("order", 0), frame.order);
  const double least = accuracy.value("shortest_step", 0.0);
  accuracy["shortest_step"] =
      least > 0 && frame.least > 0 ? std::min(least, frame.least) : least + frame.least;
  sum("error_estimate", frame.estimate);
}

Json describeVerdicts(const std::vector<scenes::Checker::Verdict>& verdicts) {
  Json json = Json::array();
  for (const scenes::Checker::Verdict& verdict : verdicts) {
    json.push_back({{"metric", verdict.expectation.metric},
                    {"body", verdict.expectation.body},
                    {"value", verdict.value},
                    {"at_time", verdict.atTime},
                    {"least", verdict.least},
                    {"most", verdict.most},
                    {"holds", verdict.holds},
                    {"text", verdict.text}});
  }
  return json;
}

std::string hexadecimal(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::optional<RunRecord> readRecord(const std::filesystem::path& folder) {
  return readRecordFile(folder / kFile);
}

std::optional<RunRecord> readRecordFile(const std::filesystem::path& path) {
  const Json json = tryParseJson(scenes::fileText(path.string()).value_or(""));
  if (!json.is_object()) return std::nullopt;
  try {
    RunRecord record;
    record.program = json.at("program");
    record.scene = json.at("scene");
    record.settings = json.at("settings");
    record.picture = json.at("picture");
    record.stateHashes = json.at("state_hashes").get<std::vector<std::string>>();
    record.expectations = json.at("expectations");
    record.seconds = json.at("seconds");
    record.video = json.at("video");
    record.accuracy = json.value("accuracy", record.accuracy);
    record.warnings = json.value("warnings", record.warnings);
    record.frames = json.value("frames", record.frames);
    record.sceneText = json.value("scene_text", record.sceneText);
    record.scenePath = json.value("scene_path", record.scenePath);
    record.finished = json.at("finished").get<bool>();
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

void writeRecord(const RunRecord& record, const std::filesystem::path& folder) {
  const Json json = {{"program", record.program},
                     {"scene", record.scene},
                     {"settings", record.settings},
                     {"picture", record.picture},
                     {"frames", record.frames},
                     {"finished", record.finished},
                     {"warnings", record.warnings},
                     {"accuracy", record.accuracy},
                     {"video", record.video},
                     {"seconds", record.seconds},
                     {"expectations", record.expectations},
                     {"scene_path", record.scenePath},
                     {"scene_text", record.sceneText},
                     {"state_hashes", record.stateHashes}};
  writeFile(folder / kFile, jsonText(json, 1) + "\n");
}

render::Quality parseQuality(const std::string& word) {
  using render::Quality;
  for (const Quality quality : {Quality::kDraft, Quality::kStandard, Quality::kPaper}) {
    if (word == qualityName(quality)) return quality;
  }
  throw scenes::InputError(fmt::format("--quality {}: expected draft, standard or paper", word));
}

const char* qualityName(render::Quality quality) {
  switch (quality) {
    case render::Quality::kDraft:
      return "draft";
    case render::Quality::kStandard:
      return "standard";
    case render::Quality::kPaper:
      return "paper";
  }
  return "";
}

}  // namespace app
