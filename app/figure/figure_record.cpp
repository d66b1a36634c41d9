// Records of figures, to and from JSON.
#include "app/figure/figure_record.h"

#include "app/base/build_info.h"
#include "app/base/output_file.h"
#include "scenes/read/file_text.h"
#include "scenes/read/settings_reader.h"

namespace app {

namespace fs = std::filesystem;

bool FigureRecord::holds() const {
  if (!problem.empty()) return false;
  return std::all_of(measures.begin(), measures.end(),
                     [](const Json& measure) { return measure.value("holds", false); });
}

namespace {

std::string methodText(const physics::Settings& settings) {
  if (settings.takesSmallSteps()) return "the default, small steps";
  return std::string(scenes::wordOf(settings.method)) + ", stepping " +
         scenes::wordOf(settings.stepping);
}

}  // namespace

FigureRecord makeFigureRecord(const scenes::FigureSheet& sheet, const std::string& asked,
                              render::Quality quality, int width) {
  FigureRecord record;
  record.name = sheet.name;
  record.title = sheet.title;
  record.claim = sheet.claim;
  record.number = sheet.number;
  record.asked = asked;
  Json scenes = Json::array();
  for (const scenes::FigureRun& run : sheet.runs) {
    scenes.push_back({{"name", run.scene.name},
                      {"text_hash", hashText(run.scene.text)},
                      {"overrides", run.scene.overrides},
                      {"method", methodText(run.scene.settings)}});
  }
  record.inputs = {{"program", programHash()},
                   {"sheet_hash", hashText(sheet.text)},
                   {"scenes", scenes},
                   {"quality", qualityName(quality)},
                   {"width", width}};
  return record;
}

void addVerdict(const scenes::FigureVerdict& verdict, FigureRecord& record) {
  record.measures.push_back({{"text", verdict.text},
                             {"measured", verdict.measured},
                             {"bound", verdict.bound},
                             {"value", verdict.value},
                             {"holds", verdict.holds}});
}

std::optional<FigureRecord> readFigureRecord(const fs::path& file) {
  const Json json = tryParseJson(scenes::fileText(file.string()).value_or(""));
  if (!json.is_object() || !json.contains("figure")) return std::nullopt;
  try {
    FigureRecord record;
    record.name = json.at("figure").get<std::string>();
    record.number = json.at("number").get<int>();
    record.title = json.at("title").get<std::string>();
    record.claim = json.at("claim").get<std::string>();
    record.asked = json.at("asked").get<std::string>();
    record.inputs = json.at("inputs");
    record.measures = json.at("measures");
    record.problem = json.at("problem").get<std::string>();
    record.seconds = json.at("seconds");
    record.files = json.at("files");
    for (const Json& name : record.files) {
      if (!fs::exists(file.parent_path() / name.get<std::string>())) return std::nullopt;
    }
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

void writeFigureRecord(const FigureRecord& record, const fs::path& folder) {
  const Json json = {{"figure", record.name},       {"number", record.number},
                     {"title", record.title},       {"claim", record.claim},
                     {"asked", record.asked},       {"inputs", record.inputs},
                     {"measures", record.measures}, {"problem", record.problem},
                     {"seconds", record.seconds},   {"files", record.files}};
  writeFile(folder / (record.name + ".json"), jsonText(json, 1) + "\n");
}

}  // namespace app
