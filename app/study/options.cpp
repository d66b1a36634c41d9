// dbd study options: what single choices buy, by the same cases with and without each.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/base/numbers.h"
#include "app/study/accuracy.h"
#include "scenes/joined.h"
#include "scenes/study/study_option.h"

namespace app {

namespace {

using scenes::StudyChoice;
using scenes::StudyOption;
using scenes::StudyTrial;

struct TrialResult {
  std::size_t option = 0, index = 0;
  std::string step;     // "h = 0.01 s, 4 substeps"
  std::string problem;  // why there is no reference; empty: none
  std::optional<Trace> with, without;
};

struct OptionState {
  std::vector<StudyOption> options;
  std::vector<TrialResult> results;
};

// False: interrupted.
bool measureTrial(const StudyOption& option, bool quick, Store& store, TrialResult& result) {
  const StudyTrial& trial = option.trials[result.index];
  const scenes::StudyCase& study = trial.study;
  const std::string inputs = inputsOf(study);
  RunKey key{fmt::format("{} {} {}", option.name, result.index, study.name), "with", trial.steps,
             trial.substeps, trial.iterations};
  try {
    const auto truth = findTruth(study, inputs, store);
    if (!truth) return false;
    for (const bool with : {true, false}) {
      const StudyChoice& choice = with ? option.with : option.without;
      scenes::StudyMethod method;
      method.set = choice.set;
      key.method = with ? "with" : "without";
      const Run run = runOf(study, method, {}, key);
      result.step = fmt::format("h = {} s, {}", numberText(run.h), key.text());
      const auto trace =
          store.findOr(key, hashInputs({inputs, scenes::joined(choice.set, "\n")}),
                       [&] { return measurePoint(study, run, truth->trace, effortOf(quick)); });
      if (!trace) return false;
      (with ? result.with : result.without) = *trace;
    }
  } catch (const scenes::InputError& error) {
    result.problem = error.what();
  }
  return true;
}

std::string outcome(const Trace& point, const std::string& unit) {
  if (!point.isOk()) return fmt::format("{}: {}", statusName(point.status), point.message);
  return fmt::format("{} {}, {} per s", numberText(point.errors.error), unit,
                     secondsText(point.cost()));
}

std::string ratioText(double with, double without) {
  if (!(with > 0) || !(without > 0) || !std::isfinite(with) || !std::isfinite(without)) return "–";
  return fmt::format("{:.3g}", without / with);
}

// A row of the page's table, lines of text and two points of a trial.
void addTrial(const OptionState& state, const TrialResult& result, ReportTable& table,
              std::vector<Trace>& points, std::string& text) {
  const StudyOption& option = state.options[result.option];
  const scenes::StudyCase& study = option.trials[result.index].study;
  text += fmt::format("  {} ({})\n", study.title, result.step);
  if (!result.problem.empty()) {
    text += "    " + result.problem + "\n";
    table.rows.push_back({{study.title}, {result.step}, {result.problem}});
    return;
  }
  const Trace &with = *result.with, &without = *result.without;
  const std::string one = outcome(with, study.unit), other = outcome(without, study.unit);
  text += fmt::format("    {:<24} {}\n    {:<24} {}\n", option.with.label, one,
                      option.without.label, other);
  table.rows.push_back({{study.title},
                        {result.step},
                        {one},
                        {other},
                        number(ratioText(with.errors.error, without.errors.error)),
                        number(ratioText(with.cost(), without.cost()))});
  points.insert(points.end(), {with, without});
}

constexpr const char* kHowCompared =
    "Each case is run with the choice and without it: the largest error against the case's "
    "reference, and the wall time per simulated second. A ratio above 1 speaks for the choice.";

StudyFindings findingsOf(const OptionState& state, const std::string& command) {
  StudyFindings findings;
  Report& report = findings.report;
  report.title = "What each choice buys";
  report.command = command;
  report.sections.push_back({"", "", {ReportText{kHowCompared}}, true});
  std::vector<Trace> points;
  for (std::size_t o = 0; o < state.options.size(); ++o) {
    const StudyOption& option = state.options[o];
    findings.text += fmt::format("{}: {}\n", option.name, option.title);
    ReportTable table{{"case", "step", option.with.label, option.without.label, "error, times less",
                       "time, times less"},
                      {}};
    for (const TrialResult& result : state.results) {
      const bool isThere = result.without || !result.problem.empty();
      if (result.option == o && isThere) addTrial(state, result, table, points, findings.text);
    }
    report.sections.push_back(
        {option.name, option.title, {ReportText{option.about}, std::move(table)}});
  }
  report.note = loadText(points);
  report.tables.emplace_back("points.csv", pointsTable(points));
  return findings;
}

}  // namespace

Study optionStudy(const StudyOptions& options, const std::filesystem::path&) {
  const auto state = std::make_shared<OptionState>();
  const bool all = options.words.empty();
  Study study;
  study.name = "options";
  for (const std::string& word : all ? scenes::studyOptions() : options.words) {
    StudyOption option = scenes::readStudyOption(word);
    if (options.quick) {
      std::erase_if(option.trials, [](const StudyTrial& trial) { return !trial.quick; });
    }
    if (option.trials.empty()) continue;
    study.listing += fmt::format("{:<24} {}: {} or {}\n", option.name, option.title,
                                 option.with.label, option.without.label);
    for (std::size_t t = 0; t < option.trials.size(); ++t) {
      state->results.push_back({state->options.size(), t, "", "", {}, {}});
      study.tasks.push_back({fmt::format("{}.{}", option.name, t), all ? option.name : word});
    }
    state->options.push_back(std::move(option));
  }
  if (state->options.empty()) throw scenes::InputError("study: nothing to measure");
  study.run = [state, quick = options.quick](std::size_t task, Store& store) {
    TrialResult& result = state->results[task];
    return measureTrial(state->options[result.option], quick, store, result);
  };
  study.find = [state, command = options.command(study.name, options.words)] {
    return std::optional(findingsOf(*state, command));
  };
  return study;
}

}  // namespace app
