// Runs to and from lines of JSON.
#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/base/output_file.h"
#include "app/commands/exit_code.h"
#include "app/study/stability_run.h"

namespace app {

namespace {

using Json = nlohmann::ordered_json;

Json toJson(const StabilityRun& run) {
  Json json = {{"case", run.key.study},
               {"method", run.key.method},
               {"level", run.key.level},
               {"inputs", run.inputs},
               {"status", static_cast<int>(run.status)},
               {"frame_count", run.frameCount},
               {"frames", run.frames},
               {"work", run.work},
               {"seconds", run.seconds},
               {"message", run.message},
               {"verdicts", Json::array()}};
  if (run.failure) {
    const StabilityFailure& f = *run.failure;
    json["failure"] = {{"frame", f.frame},
                       {"time", f.time},
                       {"what", f.what},
                       {"bodies", f.bodies},
                       {"constraint", f.constraint}};
  }
  for (const StabilityVerdict& v : run.verdicts) {
    json["verdicts"].push_back({{"text", v.text},
                                {"holds", v.holds},
                                {"value", v.value},
                                {"bound", v.bound},
                                {"at_most", v.atMost},
                                {"time", v.atTime},
                                {"line", v.line}});
  }
  return json;
}

// JSON has no infinity: such a number was written as null.
double numberOf(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::infinity();
}

StabilityRun fromJson(const Json& json) {
  StabilityRun run;
  run.key = {json.at("case"), json.at("method"), json.at("level")};
  run.inputs = json.at("inputs");
  run.status = static_cast<StabilityRun::Status>(json.at("status").get<int>());
  run.frameCount = json.at("frame_count");
  run.frames = json.at("frames");
  run.work = numberOf(json.at("work"));
  run.seconds = numberOf(json.at("seconds"));
  run.message = json.at("message");
  if (json.contains("failure")) {
    const Json& f = json.at("failure");
    run.failure = StabilityFailure{f.at("frame"), numberOf(f.at("time")), f.at("what"),
                                   f.at("bodies"), f.at("constraint")};
  }
  for (const Json& v : json.at("verdicts")) {
    run.verdicts.push_back({v.at("text"), v.at("holds"), numberOf(v.at("value")),
                            numberOf(v.at("bound")), v.at("at_most"), numberOf(v.at("time")),
                            v.at("line")});
  }
  return run;
}

std::string lineOf(const StabilityRun& run) {
  return toJson(run).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

StabilityStore::StabilityStore(std::filesystem::path path, bool keep) : path_(std::move(path)) {
  std::string text;
  if (std::ifstream in(path_, std::ios::binary); keep && in) {
    std::string line;
    while (std::getline(in, line)) {
      try {
        earlier_.push_back(fromJson(Json::parse(line)));
        text += line + "\n";
      } catch (const Json::exception&) {  // torn by what ended the program
      }
    }
  }
  writeFile(path_, text);
}

const StabilityRun* StabilityStore::find(const StabilityKey& key, const std::string& inputs) const {
  for (const StabilityRun& run : earlier_) {
    if (run.key == key && run.inputs == inputs) return &run;
  }
  return nullptr;
}

double StabilityStore::secondsOf(const StabilityKey& key) const {
  double seconds = 0;
  for (const StabilityRun& run : earlier_) {
    if (run.key == key) seconds = run.seconds;
  }
  return seconds;
}

void StabilityStore::append(const StabilityRun& run) {
  const std::string line = lineOf(run);
  const std::lock_guard lock(mutex_);
  std::FILE* file = std::fopen(path_.c_str(), "ab");
  const bool written =
      file != nullptr && std::fwrite(line.data(), 1, line.size(), file) == line.size();
  const bool closed = file != nullptr && std::fclose(file) == 0;
  if (!written || !closed) throw EnvironmentError("cannot write to " + path_.string());
}

}  // namespace app
