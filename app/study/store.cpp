// Traces to and from lines, and the files that hold them.
#include "app/study/store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "app/base/build_info.h"
#include "app/base/json.h"
#include "app/base/output_file.h"
#include "app/commands/exit_code.h"

namespace app {

namespace {

namespace fs = std::filesystem;
// The one list of what a trace holds, in the order of points.csv: `v(name, member)` for each.
template <class V, class T>
void fields(V&& v, T& t) {
  v("case", t.key.study);
  v("method", t.key.method);
  v("h", t.h);
  v("steps", t.key.steps);
  v("substeps", t.key.substeps);
  v("iterations", t.key.iterations);
  v("status", t.status);
  v("error", t.errors.error);
  v("last_error", t.errors.last);
  v("compared", t.errors.compared);
  v("residual_m", t.worst.residual);
  v("residual_rad", t.worst.residualAngle);
  v("overlap_m", t.worst.overlap);
  v("energy_drift", t.worst.energyDrift);
  v("momentum_drift", t.worst.momentumDrift);
  v("angular_momentum_drift", t.worst.angularMomentumDrift);
  v("evaluations", t.evaluations);
  v("sweeps", t.sweeps);
  v("restarts", t.restarts);
  v("fallbacks", t.fallbacks);
  v("wall", t.wall);
  v("wall_median", t.wallMedian);
  v("wall_spread", t.wallSpread);
  v("processor", t.processor);
  v("repeats", t.repeats);
  v("load", t.load);
  v("inputs", t.inputs);
  v("message", t.message);
  v("accuracy", t.key.accuracy);
  v("estimate", t.estimate);
  v("pieces", t.pieces);
  v("level", t.key.level);
  v("frame_count", t.frameCount);
  v("frames", t.frames);
  v("work", t.work);
  v("seconds", t.seconds);
}
template <class V, class T>
void failureFields(V&& v, T& f) {
  v("frame", f.frame);
  v("time", f.time);
  v("what", f.what);
  v("bodies", f.bodies);
  v("constraint", f.constraint);
}
template <class V, class T>
void verdictFields(V&& v, T& t) {
  v("metric", t.metric);
  v("text", t.text);
  v("holds", t.holds);
  v("at_most", t.atMost);
  v("value", t.value);
  v("bound", t.bound);
  v("time", t.atTime);
  v("line", t.line);
}

struct ToJson {
  Json json = Json::object();
  template <class T>
  void operator()(const char* name, const T& member) {
    if constexpr (std::is_enum_v<T>) {
      json[name] = statusName(member);
    } else {
      json[name] = member;
    }
  }
};

// JSON has no infinity: such a number was written as null.
double numberOf(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::infinity();
}

struct FromJson {
  const Json& json;
  void operator()(const char* name, double& member) const { member = numberOf(json.at(name)); }
  void operator()(const char* name, Trace::Status& member) const {
    const std::string word = json.at(name);
    for (int k = 0; k <= static_cast<int>(Trace::Status::kMissing); ++k) {
      member = static_cast<Trace::Status>(k);
      if (word == statusName(member)) return;
    }
    throw std::runtime_error("no status " + word);
  }
  template <class T>
  void operator()(const char* name, T& member) const {
    member = json.at(name).get<T>();
  }
};

struct Heads {
  std::string text;
  template <class T>
  void operator()(const char* head, const T&) {
    text += fmt::format("{}{}", text.empty() ? "" : ",", head);
  }
};

struct Row {
  std::string text;
  void add(const std::string& cell) { text += (text.empty() ? "" : ",") + cell; }
  void operator()(const char*, std::string cell) {
    std::replace(cell.begin(), cell.end(), ',', ';');
    std::replace_if(
        cell.begin(), cell.end(), [](unsigned char c) { return c < ' '; }, ' ');
    add(cell);
  }
  void operator()(const char*, int number) { add(fmt::format("{}", number)); }
  void operator()(const char*, double number) { add(fmt::format("{:.9g}", number)); }
  void operator()(const char*, Trace::Status status) { add(statusName(status)); }
};

const std::string& thisProgram() {
  static const std::string hash = programHash();
  return hash;
}

std::string idOf(const RunKey& key) {
  return fmt::format("{}\n{}\n{} {} {} {}\n{}\n", key.study, key.method, key.steps, key.substeps,
                     key.iterations, key.accuracy, key.level);
}

}  // namespace

std::string hashInputs(const std::vector<std::string>& parts) {
  std::string all = thisProgram();
  for (const std::string& part : parts) all += fmt::format("\n{}:{}", part.size(), part);
  return hashText(all);
}

std::string lineOf(const Trace& trace) {
  ToJson json;
  fields(json, trace);
  if (trace.failure) {
    ToJson own;
    failureFields(own, *trace.failure);
    json.json["failure"] = own.json;
  }
  for (const TraceVerdict& verdict : trace.verdicts) {
    ToJson own;
    verdictFields(own, verdict);
    json.json["verdicts"].push_back(own.json);
  }
  json.json["program"] = thisProgram();
  if (!trace.samples.empty()) json.json["samples"] = trace.samples;
  return jsonText(json.json) + "\n";
}

Trace parseTrace(const std::string& line) {
  const Json json = parseJson(line);
  Trace trace;
  fields(FromJson{json}, trace);
  if (json.contains("failure")) {
    failureFields(FromJson{json.at("failure")}, trace.failure.emplace());
  }
  for (const Json& own : json.value("verdicts", Json::array())) {
    verdictFields(FromJson{own}, trace.verdicts.emplace_back());
  }
  if (json.contains("samples")) {
    trace.samples = json.at("samples").get<std::vector<scenes::QuantitySamples>>();
  }
  return trace;
}

std::string pointsTable(const std::vector<Trace>& traces) {
  Heads heads;
  const Trace none;
  fields(heads, none);
  std::string table = heads.text + "\n";
  for (const Trace& trace : traces) {
    Row row;
    fields(row, trace);
    table += row.text + "\n";
  }
  return table;
}

Store::Store(fs::path folder, StoreMode mode, const std::string& job) : mode_(mode) {
  const fs::path whole = folder / "runs.jsonl", jobs = folder / "runs";
  path_ = job.empty() ? whole : jobs / (job + ".jsonl");
  if (mode != StoreMode::kLook) makeFolder(path_.parent_path());
  std::vector<fs::path> others;
  if (job.empty() && fs::is_directory(jobs)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(jobs)) {
      if (entry.path().extension() == ".jsonl") others.push_back(entry.path());
    }
  }
  std::sort(others.begin(), others.end());
  if (mode != StoreMode::kFresh) {
    read(whole);
    for (const fs::path& other : others) read(other);
    if (path_ != whole) read(path_);
  }
  if (mode == StoreMode::kLook) return;
  std::string text;
  if (job.empty()) {
    for (const auto& [id, trace] : earlier_) text += lineOf(trace);
  } else if (std::ifstream own(path_, std::ios::binary); own && mode != StoreMode::kFresh) {
    for (std::string line; std::getline(own, line) && !own.eof();) text += line + "\n";
  }
  writeFile(path_, text);
}

void Store::read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  for (std::string line; std::getline(in, line);) {
    // How long it took is worth knowing of another program, too.
    if (mode_ != StoreMode::kLook && line.find(thisProgram()) == std::string::npos) continue;
    try {
      Trace trace = parseTrace(line);
      const std::string id = idOf(trace.key) + trace.inputs;
      earlier_.insert_or_assign(id, std::move(trace));
    } catch (const std::exception&) {  // torn by what ended the program
    }
  }
}

const Trace* Store::find(const RunKey& key, const std::string& inputs) const {
  const auto found = earlier_.find(idOf(key) + inputs);
  if (found == earlier_.end()) return nullptr;
  return found->second.status == Trace::Status::kSkipped && runs() ? nullptr : &found->second;
}

double Store::secondsOf(const RunKey& key) const {
  const auto found = earlier_.lower_bound(idOf(key));
  return found == earlier_.end() || found->second.key != key ? 0 : found->second.seconds;
}

std::optional<Trace> Store::findOr(const RunKey& key, const std::string& inputs,
                                   const std::function<std::optional<Trace>()>& make) {
  if (const Trace* known = find(key, inputs)) {
    ++reused_;
    return *known;
  }
  return remake(key, inputs, make);
}

std::optional<Trace> Store::remake(const RunKey& key, const std::string& inputs,
                                   const std::function<std::optional<Trace>()>& make) {
  if (!runs()) {
    ++missing_;
    Trace trace;
    trace.key = key;
    trace.status = Trace::Status::kMissing;
    return trace;
  }
  std::optional<Trace> trace = make();
  if (!trace) return std::nullopt;
  trace->key = key;
  trace->inputs = inputs;
  append(*trace);
  return trace;
}

void Store::append(const Trace& trace) {
  const std::string line = lineOf(trace);
  const std::lock_guard lock(mutex_);
  std::FILE* file = std::fopen(path_.c_str(), "ab");
  const bool written =
      file != nullptr && std::fwrite(line.data(), 1, line.size(), file) == line.size();
  const bool closed = file != nullptr && std::fclose(file) == 0;
  if (!written || !closed) throw EnvironmentError("cannot write to " + path_.string());
}

}  // namespace app
