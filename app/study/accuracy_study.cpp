// dbd study accuracy: what its cases consist of, and measuring what is missing of them.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/study/accuracy.h"
#include "scenes/joined.h"
#include "scenes/read/value.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using scenes::StudyCase;
using Status = Trace::Status;

// Only the methods asked for; an unknown word is an error.
void keepMethods(const std::vector<std::string>& wanted, StudyCase& study) {
  if (wanted.empty()) return;
  std::vector<scenes::StudyMethod> methods;
  std::vector<scenes::StudyGrid> grids;
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    if (std::find(wanted.begin(), wanted.end(), study.methods[m].name) == wanted.end()) continue;
    methods.push_back(study.methods[m]);
    grids.push_back(study.grids[m]);
  }
  study.methods = std::move(methods);
  study.grids = std::move(grids);
}

std::vector<std::string> wantedMethods(const std::string& list) {
  std::vector<std::string> known, wanted(1);
  for (const char c : list) c == ',' ? wanted.emplace_back() : wanted.back() += c;
  std::erase(wanted, "");
  for (const scenes::StudyMethod& method : scenes::studyMethods()) known.push_back(method.name);
  for (const std::string& word : wanted) {
    if (std::find(known.begin(), known.end(), word) != known.end()) continue;
    throw scenes::InputError(
        fmt::format("--methods: no method '{}'{}", word, scenes::didYouMean(word, known)));
  }
  return wanted;
}

// A case as it is measured.
struct Measured {
  std::string word, inputs;  // of the command line; of all its methods
  std::optional<StudyTruth> truth;
  CaseResults results;
};

// How long the run of `key` will take [s], from those of the same method and as many iterations
// that were measured.
double expectedSeconds(const CaseResults& results, const RunKey& key) {
  double seconds = 0;
  for (const Trace& point : results.points) {
    const bool same = point.key.method == key.method && point.key.iterations == key.iterations;
    if (!same || !(point.isOk() || point.isFailure())) continue;
    seconds = point.cost() * results.study.duration * key.work() / point.key.work();
  }
  return seconds;
}

std::optional<Trace> measurePlanned(Measured& m, const PlannedPoint& planned,
                                    const PointEffort& effort) {
  const auto k = static_cast<std::size_t>(planned.method);
  const StudyCase& study = m.results.study;
  const Run run = runOf(study, study.methods[k], study.grids[k], planned.key);
  const double expected = expectedSeconds(m.results, planned.key);
  if (expected <= effort.longest) return measurePoint(study, run, m.truth->trace, effort);
  Trace trace;
  trace.h = planned.key.accuracy > 0 ? 0 : run.h;
  trace.status = Status::kSkipped;
  trace.message = fmt::format("about {:.0f} s", expected);
  return trace;
}

// False: interrupted.
bool measureMethod(int method, bool quick, Measured& m, Store& store) {
  const scenes::StudyMethod& own = m.results.study.methods[static_cast<std::size_t>(method)];
  std::vector<std::string> parts = own.set;
  parts.push_back(m.inputs + own.peer);
  const std::string inputs = hashInputs(parts);
  for (const PlannedPoint& planned : planPoints(m.results.study, quick)) {
    if (planned.method != method) continue;
    const auto trace = store.findOr(planned.key, inputs,
                                    [&] { return measurePlanned(m, planned, effortOf(quick)); });
    if (!trace) return false;
    if (trace->status == Status::kMissing) continue;
    m.results.points.push_back(*trace);
    // What a method cannot do once it cannot do with other steps.
    if (trace->status == Status::kRefused) return true;
  }
  return true;
}

struct AccuracyTask {
  std::size_t measured = 0;
  int first = 0, last = 0;  // methods
};

struct AccuracyState {
  std::vector<Measured> cases;
  std::vector<AccuracyTask> tasks;
};

bool runTask(const AccuracyTask& task, bool quick, AccuracyState& state, Store& store) {
  Measured& m = state.cases[task.measured];
  try {
    if (!m.truth) m.truth = findTruth(m.results.study, m.inputs, store);
    if (!m.truth) return false;
  } catch (const scenes::InputError& error) {
    m.results.problem = error.what();
    return true;
  }
  m.results.reference = m.truth->report;
  for (int method = task.first; method < task.last; ++method) {
    if (!measureMethod(method, quick, m, store)) return false;
  }
  return true;
}

// All are read before the first is measured: a mistake in the last must not cost hours.
std::shared_ptr<AccuracyState> readCases(const StudyOptions& options) {
  auto state = std::make_shared<AccuracyState>();
  const std::vector<std::string> wanted = wantedMethods(options.methods);
  const bool all = options.words.empty();
  for (const std::string& word : all ? scenes::studyCases() : options.words) {
    StudyCase study = scenes::readStudyCase(word);
    if (all && options.quick && !study.quick) continue;
    study.set.insert(study.set.end(), options.common.overrides.begin(),
                     options.common.overrides.end());
    study.duration = scenes::studyScene(study, {}).duration;
    keepMethods(wanted, study);
    for (const Measured& other : state->cases) {
      if (other.results.study.name != study.name) continue;
      throw scenes::InputError(
          fmt::format("{} and {} have the same name", other.results.study.path, study.path));
    }
    if (study.methods.empty()) continue;
    Measured& measured = state->cases.emplace_back();
    measured.word = all ? study.name : word;
    measured.inputs = inputsOf(study);
    measured.results.study = std::move(study);
  }
  if (state->cases.empty()) throw scenes::InputError("study: no case has any of these methods");
  return state;
}

// A task for each method, or one for all where they share a reference run.
void planTasks(const StudyOptions& options, AccuracyState& state, Study& study) {
  const double seconds = effortOf(options.quick).repeats.longest;
  for (std::size_t i = 0; i < state.cases.size(); ++i) {
    const Measured& m = state.cases[i];
    const StudyCase& own = m.results.study;
    const auto count = static_cast<int>(own.methods.size());
    const auto points = static_cast<double>(planPoints(own, options.quick).size());
    if (own.reference.self) {
      state.tasks.push_back({i, 0, count});
      study.tasks.push_back({own.name, m.word, seconds * points});
      continue;
    }
    for (int method = 0; method < count; ++method) {
      state.tasks.push_back({i, method, method + 1});
      study.tasks.push_back({own.name + "." + own.methods[static_cast<std::size_t>(method)].name,
                             m.word, seconds * points / count});
    }
  }
}

}  // namespace

Study accuracyStudy(const StudyOptions& options, const fs::path& folder) {
  const std::shared_ptr<AccuracyState> state = readCases(options);
  Study study;
  study.name = "accuracy";
  for (const Measured& m : state->cases) {
    std::vector<std::string> methods;
    for (const auto& method : m.results.study.methods) methods.push_back(method.name);
    study.listing +=
        fmt::format("{:<24} {}{}\n{:<24}   {}\n", m.results.study.name, m.results.study.title,
                    m.results.study.quick ? " (quick)" : "", "", scenes::joined(methods, " "));
  }
  planTasks(options, *state, study);
  study.run = [state, quick = options.quick](std::size_t task, Store& store) {
    return runTask(state->tasks[task], quick, *state, store);
  };
  study.find = [state, folder, command = options.command(study.name, options.words)] {
    std::vector<const CaseResults*> cases;
    for (const Measured& m : state->cases) {
      if (!m.results.points.empty() || !m.results.problem.empty()) cases.push_back(&m.results);
    }
    return accuracyFindings(cases, command, folder);
  };
  return study;
}

}  // namespace app
