// Reference runs, and the file that keeps them.
#include "app/study/study_reference.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <future>
#include <sstream>

#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/base/stopwatch.h"
#include "app/study/study_run.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using scenes::StudyCase;
using scenes::StudyTrace;

// The reference with `divide` times fewer substeps, or steps where their number cannot be divided.
StudyKey keyOf(const StudyCase& study, int divide) {
  const scenes::StudyGrid& run = study.reference.run;
  StudyKey key{study.name, "reference", run.steps[0], run.substeps[0], run.iterations[0]};
  int& divided = key.substeps % divide == 0 ? key.substeps : key.steps;
  divided /= divide;
  return key;
}

// None: interrupted.
std::optional<StudyTrace> runReference(const StudyCase& study, const StudyKey& key) {
  scenes::StudyMethod method;
  method.set = study.reference.run.set;
  const scenes::Scene scene = scenes::studyScene(study, overridesOf({}, method, study, key));
  StudyRun run(scene, study, method, key);
  scenes::StudyTracer tracer(study, run.simulation());
  tracer.observe(run.simulation());
  for (int k = 1; k < study.sampleCount(); ++k) {
    if (interrupted()) return std::nullopt;
    if (!run.advance()) {
      throw scenes::InputError(
          fmt::format("{}: the reference run failed: {}", study.path, run.problem()));
    }
    tracer.observe(run.simulation());
  }
  return tracer.trace();
}

std::string whatRan(const StudyCase& study) {
  const StudyKey key = keyOf(study, 1);
  std::string words;
  for (const std::string& setting : study.reference.run.set) words += ", " + setting;
  return fmt::format("a run of its own at h = {:.3g} s{}", stepOf(study, key), words);
}

fs::path fileOf(const StudyCase& study, const fs::path& folder) {
  return folder / "references" / (study.name + ".csv");
}

// The kept reference; none where it is absent or was made from something else.
std::optional<StudyTruth> readKept(const StudyCase& study, const std::string& inputs,
                                   const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  StudyTruth kept;
  std::string hash;
  double accuracy = 0;
  if (!std::getline(in, line)) return std::nullopt;
  std::istringstream head(line);
  std::string mark;
  if (!(head >> mark >> hash >> accuracy >> kept.report.seconds) || hash != inputs) {
    return std::nullopt;
  }
  std::ostringstream rest;
  rest << in.rdbuf();
  auto trace = parseTrace(rest.str(), study.quantities.size(), study.sampleCount());
  if (!trace) return std::nullopt;
  kept.trace = scenes::truthOf(study, &*trace);
  kept.report.accuracy = accuracy;
  kept.report.what = whatRan(study);
  return kept;
}

std::optional<StudyTruth> runSelf(const StudyCase& study, const std::string& inputs,
                                  const fs::path& file) {
  const Stopwatch watch;
  auto half = std::async(std::launch::async, [&] { return runReference(study, keyOf(study, 2)); });
  const auto fine = runReference(study, keyOf(study, 1));
  const auto coarse = half.get();
  if (!fine || !coarse) return std::nullopt;
  StudyTruth truth;
  truth.trace = scenes::truthOf(study, &*fine);
  truth.report.accuracy = scenes::compare(study, *coarse, truth.trace).error;
  truth.report.seconds = watch.seconds();
  truth.report.what = whatRan(study);
  makeFolder(file.parent_path());
  writeFile(file, fmt::format("# {} {:.17g} {:.6g}\n{}", inputs, *truth.report.accuracy,
                              truth.report.seconds, traceText(*fine)));
  return truth;
}

std::string nameOfTable(const StudyCase& study) {
  if (study.reference.table.empty()) return "closed form";
  std::string name = "table " + fs::path(study.reference.table).filename().string();
  for (const auto& [column, value] : study.reference.where) {
    name += fmt::format(", {} = {:g}", column, value);
  }
  return name;
}

}  // namespace

std::optional<StudyTruth> findTruth(const StudyCase& study, const std::string& inputs,
                                    const fs::path& folder) {
  if (!study.reference.self) {
    StudyTruth truth;
    truth.trace = scenes::truthOf(study, nullptr);
    truth.report.what = nameOfTable(study);
    truth.report.accuracy = scenes::tableAccuracy(study);
    return truth;
  }
  const fs::path file = fileOf(study, folder);
  if (std::optional<StudyTruth> kept = readKept(study, inputs, file)) return kept;
  return runSelf(study, inputs, file);
}

std::string traceText(const StudyTrace& trace) {
  std::string text;
  for (std::size_t q = 0; q < trace.quantities.size(); ++q) {
    for (std::size_t k = 0; k < trace.quantities[q].size(); ++k) {
      text += fmt::format("{},{}", q, k);
      for (const double value : trace.quantities[q][k]) text += fmt::format(",{:.17g}", value);
      text += '\n';
    }
  }
  return text;
}

std::optional<StudyTrace> parseTrace(const std::string& text, std::size_t quantities, int samples) {
  StudyTrace trace;
  trace.samples = samples;
  trace.quantities.resize(quantities);
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const char* at = line.c_str();
    char* end = nullptr;
    const std::size_t q = std::strtoul(at, &end, 10);
    if (end == at || *end != ',' || q >= quantities) return std::nullopt;
    const std::size_t k = std::strtoul(end + 1, &end, 10);
    if (k != trace.quantities[q].size()) return std::nullopt;
    std::vector<double>& values = trace.quantities[q].emplace_back();
    while (*end == ',') values.push_back(std::strtod(end + 1, &end));
  }
  for (const scenes::QuantitySamples& own : trace.quantities) {
    if (static_cast<int>(own.size()) != samples) return std::nullopt;
  }
  return trace;
}

}  // namespace app
