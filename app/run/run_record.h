// run.json: what made the files of an output folder, and with which result.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "render/renderer.h"
#include "scenes/simulation.h"

namespace app {

struct RunRecord {
  // What the states depend on, and what the frames depend on beside them (null: nothing was drawn).
  Json program, scene, settings, picture;
  std::string sceneText, scenePath;  // scenes::textOf, and where its assets are looked for
  std::string frames;                // that were asked for last, as --frames takes them

  std::vector<std::string> stateHashes;  // per frame; empty text: not known
  Json expectations = Json::array();     // verdicts, once the whole run was simulated
  Json seconds = Json::object();         // per stage; runs of the same inputs add up
  Json accuracy;                         // how it was kept, where one is asked for; else null
  Json video;                            // the film and its frames; null: none
  std::vector<std::string> warnings;     // Scene::told, scenes/measure/start_warnings.h
  bool finished = false;                 // all that was asked for is written

  void addSeconds(const std::string& stage, double more);
  bool sameStates(const RunRecord& other) const;
  bool sameFrames(const RunRecord& other) const;
};

RunRecord makeRecord(const scenes::Scene& scene);
std::string sceneHash(const scenes::Scene& scene);  // of scenes::textOf, 16 hex digits
void noteWarnings(const RunRecord& record);         // on stderr
void noteWarnings(const std::string& scene, const std::vector<std::string>& warnings);
Json describePicture(const render::RendererOptions& options, const render::Renderer::Info& info,
                     bool hud, const scenes::Overlays& overlays);
// Of a frame, onto RunRecord::accuracy: asked, accepted_steps, rejected_steps, order (the highest),
// shortest_step [s], error_estimate (their sum: errors add up).
void addAccuracy(const scenes::Scene& scene, const physics::AccuracyReport& frame, Json& accuracy);
Json describeVerdicts(const std::vector<scenes::Checker::Verdict>& verdicts);
// "--size, width: 640 -> 1280": what sameFrames() goes by.
std::vector<std::string> differencesOf(const RunRecord& was, const RunRecord& is);
std::string hexadecimal(std::uint64_t hash);

// Absent or unreadable: nullopt, and the folder is treated as new.
std::optional<RunRecord> readRecord(const std::filesystem::path& folder);
std::optional<RunRecord> readRecordFile(const std::filesystem::path& file);
void writeRecord(const RunRecord& record, const std::filesystem::path& folder);

const char* qualityName(render::Quality quality);
render::Quality parseQuality(const std::string& word);  // throws InputError that names --quality

}  // namespace app
