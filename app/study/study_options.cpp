// One choice, three cases, two runs each.
#include "app/study/study_options.h"

#include <fmt/format.h>

#include <cmath>

#include "app/base/build_info.h"
#include "app/base/html.h"
#include "app/study/study_effort.h"
#include "app/study/study_reference.h"
#include "app/study/study_run.h"
#include "app/study/study_table.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using scenes::StudyChoice;
using scenes::StudyOption;
using scenes::StudyTrial;

scenes::StudyMethod methodOf(const char* name, const StudyChoice& choice) {
  scenes::StudyMethod method;
  method.name = name;
  method.title = choice.label;
  method.set = choice.set;
  return method;
}

// None: interrupted.
std::optional<StudyPoint> measureChoice(const StudyTrial& trial, const StudyKey& key,
                                        const StudyChoice& choice, const StudyTruth& truth,
                                        const std::string& inputs, bool quick, PointStore& store) {
  if (const StudyPoint* known = store.find(key, inputs)) return *known;
  std::optional<StudyPoint> point = measurePoint(trial.study, methodOf(key.method.c_str(), choice),
                                                 {}, key, truth.trace, effortOf(quick));
  if (!point) return std::nullopt;
  point->inputs = inputs;
  store.append(*point);
  return point;
}

std::string outcome(const StudyPoint& point, const std::string& unit) {
  if (!point.isOk()) return fmt::format("{}: {}", statusName(point.status), point.message);
  return fmt::format("{} {}, {} per s", numberText(point.errors.error), unit,
                     secondsText(point.cost()));
}

std::string ratioText(double with, double without) {
  if (!(with > 0) || !(without > 0) || !std::isfinite(with) || !std::isfinite(without)) return "–";
  return fmt::format("{:.3g}", without / with);
}

}  // namespace

std::optional<TrialResult> measureTrial(const StudyOption& option, int index, bool quick,
                                        PointStore& store, const fs::path& folder) {
  const StudyTrial& trial = option.trials[static_cast<std::size_t>(index)];
  const scenes::StudyCase& study = trial.study;
  const std::string inputs = studyInputs(study);
  TrialResult result;
  result.title = study.title;
  result.unit = study.unit;
  StudyKey key{fmt::format("{} {} {}", option.name, index, study.name), "with", trial.steps,
               trial.substeps, trial.iterations};
  result.step = fmt::format("h = {} s, {}", numberText(stepOf(study, key)), key.text());
  try {
    const auto truth = findTruth(study, inputs, folder);
    if (!truth) return std::nullopt;
    for (const bool with : {true, false}) {
      const StudyChoice& choice = with ? option.with : option.without;
      key.method = with ? "with" : "without";
      const auto point = measureChoice(trial, key, choice, *truth,
                                       hashText(inputs + joinedLines(choice.set)), quick, store);
      if (!point) return std::nullopt;
      (with ? result.with : result.without) = *point;
    }
  } catch (const scenes::InputError& error) {
    result.problem = error.what();
  }
  return result;
}

std::string optionText(const OptionResult& result) {
  std::string text = fmt::format("{}: {}\n", result.option.name, result.option.title);
  for (const TrialResult& trial : result.trials) {
    text += fmt::format("  {} ({})\n", trial.title, trial.step);
    if (!trial.problem.empty()) {
      text += "    " + trial.problem + "\n";
      continue;
    }
    text += fmt::format("    {:<24} {}\n    {:<24} {}\n", result.option.with.label,
                        outcome(trial.with, trial.unit), result.option.without.label,
                        outcome(trial.without, trial.unit));
  }
  return text;
}

std::string optionSection(const OptionResult& result) {
  const StudyOption& option = result.option;
  std::string html = fmt::format(
      "<section id=\"{}\"><h2>{}</h2>\n<p>{}</p>\n<table><tr><th>case</th><th>step</th><th>{}</th>"
      "<th>{}</th><th>error, times less</th><th>time, times less</th></tr>\n",
      escapeHtml(option.name), escapeHtml(option.title), escapeHtml(option.about),
      escapeHtml(option.with.label), escapeHtml(option.without.label));
  for (const TrialResult& trial : result.trials) {
    html +=
        fmt::format("<tr><td>{}</td><td>{}</td>", escapeHtml(trial.title), escapeHtml(trial.step));
    if (!trial.problem.empty()) {
      html += "<td colspan=\"4\">" + escapeHtml(trial.problem) + "</td></tr>\n";
      continue;
    }
    html += fmt::format(
        "<td>{}</td><td>{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td></tr>\n",
        escapeHtml(outcome(trial.with, trial.unit)), escapeHtml(outcome(trial.without, trial.unit)),
        ratioText(trial.with.errors.error, trial.without.errors.error),
        ratioText(trial.with.cost(), trial.without.cost()));
  }
  return html + "</table></section>\n";
}

}  // namespace app
