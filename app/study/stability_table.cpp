// The stability study in lines and tables of text.
#include <fmt/format.h>

#include <algorithm>

#include "app/study/stability_map.h"
#include "app/study/stability_page.h"

namespace app {

namespace {

std::string cell(std::string text) {
  for (char& c : text) {
    if (c == ',') c = ';';
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.9g}", *value) : "";
}

}  // namespace

std::string verdictText(const StabilityResult& result) {
  if (!result.problem.empty()) {
    return fmt::format("FAIL  {:<24} {}\n", result.study.name, result.problem);
  }
  const StabilityRun& run = result.stated;
  std::string text = fmt::format("{:<5} {:<24} {}\n", run.holds() ? "ok" : "FAIL",
                                 result.study.name, result.study.title);
  for (const StabilityVerdict& verdict : run.verdicts) {
    const std::string margin = verdict.margin();
    text += fmt::format("      {:<5} {}{}  (at {:.4g} s; line {})\n", verdict.holds ? "ok" : "FAIL",
                        verdict.text, margin.empty() ? "" : ": " + margin, verdict.atTime,
                        verdict.line);
  }
  if (run.verdicts.empty() && run.holds()) text += "      states no expectation\n";
  if (run.holds()) return text;
  if (!run.message.empty()) text += "      " + run.message + "\n";
  if (run.failure) {
    text += fmt::format("      first bad frame {} ({:.4g} s): {}{}\n", run.failure->frame,
                        run.failure->time, run.failure->what,
                        run.failure->where().empty() ? "" : ", at " + run.failure->where());
  }
  return text + "      " + reproduction(result.study, {}, run) + "\n";
}

std::string severityText(const StabilityResult& result) {
  if (result.bars.empty()) return "";
  const scenes::StabilitySeverity& severity = *result.study.severity;
  std::string text = fmt::format("{}: {}{}, stated {}\n", result.study.name, severity.label,
                                 severity.unit.empty() ? "" : " [" + severity.unit + "]",
                                 levelText(severity.stated));
  for (const StabilityBar& bar : result.bars) {
    const std::string holds =
        bar.border.holds ? "holds to " + levelText(*bar.border.holds) : "holds nowhere";
    const std::string fails = bar.border.fails ? ", fails " + borderText(bar)
                              : bar.isSpent    ? ", " + borderText(bar)
                                               : "";
    text += fmt::format("      {:<34} {}{}\n", bar.way.title, holds, fails);
  }
  return text;
}

std::string casesTable(const std::vector<StabilityResult>& results) {
  std::string table =
      "case,family,status,expectation,holds,value,bound,time,failed_frame,failed_bodies,"
      "failed_constraint,frames,seconds,message\n";
  for (const StabilityResult& result : results) {
    const StabilityRun& run = result.stated;
    const bool isRead = result.problem.empty();
    const std::string head = fmt::format("{},{},{}", result.study.name, result.study.family.name,
                                         isRead ? statusName(run.status) : "not read");
    const StabilityFailure failure = run.failure.value_or(StabilityFailure{});
    const std::string tail =
        fmt::format("{},{},{},{},{:.3f},{}\n", run.failure ? std::to_string(failure.frame) : "",
                    cell(failure.bodies), cell(failure.constraint), run.frames, run.seconds,
                    cell(isRead ? run.message : result.problem));
    for (const StabilityVerdict& verdict : run.verdicts) {
      table +=
          fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{}", head, cell(verdict.text),
                      verdict.holds ? 1 : 0, verdict.value, verdict.bound, verdict.atTime, tail);
    }
    if (run.verdicts.empty()) table += head + ",,,,,," + tail;
  }
  return table;
}

std::string severityTable(const std::vector<StabilityResult>& results) {
  std::string table =
      "case,method,label,unit,from,to,stated,holds,fails,holds_beyond,trials,what,bodies,"
      "constraint,frame,cut_short\n";
  for (const StabilityResult& result : results) {
    for (const StabilityBar& bar : result.bars) {
      const scenes::StabilitySeverity& s = *result.study.severity;
      const SeverityBorder& b = bar.border;
      StabilityFailure failure;
      if (bar.firstFailure) failure = bar.firstFailure->failure.value_or(failure);
      table += fmt::format(
          "{},{},{},{},{:.9g},{:.9g},{:.9g},{},{},{},{},{},{},{},{},{}\n", result.study.name,
          bar.way.method.empty() ? "family" : bar.way.method, cell(s.label), cell(s.unit), s.from,
          s.to, s.stated, number(b.holds), number(b.fails), number(b.holdsBeyond), b.trials.size(),
          cell(failure.what), cell(failure.bodies), cell(failure.constraint),
          bar.firstFailure ? std::to_string(failure.frame) : "", bar.isSpent ? 1 : 0);
    }
  }
  return table;
}

std::vector<scenes::StabilityFamily> familiesOf(const std::vector<StabilityResult>& results) {
  std::vector<scenes::StabilityFamily> families;
  for (const StabilityResult& result : results) {
    const auto same = [&](const auto& family) { return family.name == result.study.family.name; };
    if (std::none_of(families.begin(), families.end(), same)) {
      families.push_back(result.study.family);
    }
  }
  return families;
}

std::vector<const StabilityResult*> casesOf(const std::vector<StabilityResult>& results,
                                            const std::string& family) {
  std::vector<const StabilityResult*> cases;
  for (const StabilityResult& result : results) {
    if (result.study.family.name == family) cases.push_back(&result);
  }
  return cases;
}

}  // namespace app
