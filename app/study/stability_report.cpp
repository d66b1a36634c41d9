// The stability study as a page, tables and lines of text.
#include <fmt/format.h>

#include <algorithm>

#include "app/base/numbers.h"
#include "app/study/stability.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using Look = ReportCell::Look;
using Results = std::vector<StabilityResult>;

ReportCell verdictCell(bool holds) {
  return holds ? ReportCell{"ok", Look::kGood} : ReportCell{"FAIL", Look::kBad};
}

// The number that is closest to its bound, or has passed it. That numbers stay finite is none.
const TraceVerdict* tightest(const Trace& trace) {
  const TraceVerdict* most = nullptr;
  for (const TraceVerdict& verdict : trace.verdicts) {
    const bool isNumber = verdict.metric != "finite" || !verdict.holds;
    if (isNumber && (most == nullptr || verdict.share() > most->share())) most = &verdict;
  }
  return most;
}

ReportSection contents(const Results& results) {
  ReportTable table{{"", "case", "the tightest number", ""}, {}, ""};
  for (const StabilityResult& result : results) {
    const TraceVerdict* verdict = result.stated ? tightest(*result.stated) : nullptr;
    std::string text = result.problem;
    if (result.stated) text = verdict != nullptr ? verdict->text : result.stated->message;
    const std::string& title = result.study.title;
    table.rows.push_back(
        {verdictCell(result.holds()),
         {title.empty() ? result.study.name : title, Look::kPlain, result.study.name},
         {text},
         {verdict != nullptr ? verdict->margin() : ""}});
  }
  return {"cases", "Cases", {std::move(table)}};
}

ReportShots shotsOf(const std::vector<StabilityShot>& shots, const std::string& foldedUnder = "") {
  ReportShots result{{}, foldedUnder};
  for (const StabilityShot& shot : shots) result.files.emplace_back(shot.file, shot.caption);
  return result;
}

std::string failureLine(const Trace& trace) {
  const TraceFailure& failure = *trace.failure;
  return fmt::format("first bad frame {} ({:.4g} s): {}{}", failure.frame, failure.time,
                     failure.what, failure.where().empty() ? "" : ", at " + failure.where());
}

void addVerdicts(const StabilityResult& result, ReportSection& section) {
  const Trace& trace = *result.stated;
  ReportTable table{{"", "criterion", "margin", "at, s"}, {}, ""};
  for (const TraceVerdict& verdict : trace.verdicts) {
    table.rows.push_back({verdictCell(verdict.holds),
                          {verdict.text},
                          {verdict.margin()},
                          number(fmt::format("{:.4g}", verdict.atTime))});
  }
  if (!table.rows.empty()) section.blocks.push_back(std::move(table));
  if (!trace.isOk()) {
    if (!trace.message.empty()) section.blocks.push_back(ReportText{trace.message, Look::kBad});
    if (trace.failure) section.blocks.push_back(ReportText{failureLine(trace), Look::kBad});
    section.blocks.push_back(ReportText{reproduction(result.study, {}, trace), Look::kPlain, true});
  }
  section.blocks.push_back(shotsOf(result.failureShots));
  section.blocks.push_back(shotsOf(result.shots));
}

std::vector<ReportCell> barRow(const StabilityBar& bar) {
  const auto level = [](const std::optional<double>& value) {
    return number(value ? levelText(*value) : std::string("–"));
  };
  std::string where, what;
  if (bar.firstFailure && bar.firstFailure->failure) {
    const TraceFailure& failure = *bar.firstFailure->failure;
    what = failure.what;
    where = fmt::format("{}{}frame {}", failure.where(), failure.where().empty() ? "" : ", ",
                        failure.frame);
  } else if (bar.firstFailure) {
    what = bar.firstFailure->message;
  }
  if (bar.border.holdsBeyond) {
    what += fmt::format(" (not monotone: holds again at {})", levelText(*bar.border.holdsBeyond));
  }
  if (bar.isSpent)
    what += fmt::format("{}(search cut short: too much work)", what.empty() ? "" : " ");
  return {{bar.way.title}, level(bar.border.holds), level(bar.border.fails), {what}, {where}};
}

void addBars(const StabilityResult& result, ReportSection& section) {
  if (result.bars.empty()) return;
  const scenes::StabilitySeverity& s = *result.study.severity;
  section.blocks.push_back(
      ReportText{fmt::format("How far it can be pushed: {}{}, stated {}, searched from {} to {}.",
                             s.label, s.unit.empty() ? "" : " [" + s.unit + "]",
                             levelText(s.stated), levelText(s.from), levelText(s.to))});
  ReportTable table{{"method", "holds to", "fails at", "what fails first", "where"}, {}, ""};
  for (const StabilityBar& bar : result.bars) table.rows.push_back(barRow(bar));
  section.blocks.push_back(std::move(table));
  for (const StabilityBar& bar : result.bars) {
    if (bar.shots.empty()) continue;
    const std::string title = bar.way.title + " at " + levelText(*bar.border.fails);
    section.blocks.push_back(shotsOf(bar.shots, title));
    section.blocks.push_back(ReportText{
        reproduction(result.study, overridesOf(bar.way, s, *bar.border.fails), *bar.firstFailure),
        Look::kQuiet, true});
  }
}

ReportSection caseSection(const StabilityResult& result) {
  ReportSection section{result.study.name, result.study.title, {ReportText{result.study.about}}};
  if (!result.stated) {
    section.blocks.push_back(ReportText{result.problem, Look::kBad});
    return section;
  }
  addVerdicts(result, section);
  addBars(result, section);
  return section;
}

std::string csvNumber(const std::optional<double>& value) {
  return value ? fmt::format("{:.9g}", *value) : "";
}

std::string casesTable(const Results& results) {
  std::string table =
      "case,family,status,expectation,holds,value,bound,time,failed_frame,failed_bodies,"
      "failed_constraint,frames,seconds,message\n";
  for (const StabilityResult& result : results) {
    const Trace trace = result.stated.value_or(Trace{});
    const std::string head =
        fmt::format("{},{},{}", result.study.name, result.study.family.name,
                    result.problem.empty() ? stabilityWord(trace) : "not read");
    const TraceFailure failure = trace.failure.value_or(TraceFailure{});
    const std::string tail =
        fmt::format("{},{},{},{},{:.3f},{}\n", trace.failure ? std::to_string(failure.frame) : "",
                    csvCell(failure.bodies), csvCell(failure.constraint), trace.frames,
                    trace.seconds, csvCell(trace.message + result.problem));
    for (const TraceVerdict& verdict : trace.verdicts) {
      table +=
          fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{}", head, csvCell(verdict.text),
                      verdict.holds ? 1 : 0, verdict.value, verdict.bound, verdict.atTime, tail);
    }
    if (trace.verdicts.empty()) table += head + ",,,,,," + tail;
  }
  return table;
}

std::string severityTable(const Results& results) {
  std::string table =
      "case,method,label,unit,from,to,stated,holds,fails,holds_beyond,trials,what,bodies,"
      "constraint,frame,cut_short\n";
  for (const StabilityResult& result : results) {
    for (const StabilityBar& bar : result.bars) {
      const scenes::StabilitySeverity& s = *result.study.severity;
      const SeverityBorder& b = bar.border;
      TraceFailure failure;
      if (bar.firstFailure) failure = bar.firstFailure->failure.value_or(failure);
      table +=
          fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g},{},{},{},{},{},{},{},{},{}\n",
                      result.study.name, bar.way.method.empty() ? "family" : bar.way.method,
                      csvCell(s.label), csvCell(s.unit), s.from, s.to, s.stated, csvNumber(b.holds),
                      csvNumber(b.fails), csvNumber(b.holdsBeyond), b.trials.size(),
                      csvCell(failure.what), csvCell(failure.bodies), csvCell(failure.constraint),
                      bar.firstFailure ? std::to_string(failure.frame) : "", bar.isSpent ? 1 : 0);
    }
  }
  return table;
}

// Of each family its name, its map and its cases, in the order of the file.
void addFamilies(const Results& results, std::vector<ReportSection>& sections) {
  std::vector<std::string> done;
  for (const StabilityResult& first : results) {
    const scenes::StabilityFamily& family = first.study.family;
    if (std::find(done.begin(), done.end(), family.name) != done.end()) continue;
    done.push_back(family.name);
    std::vector<const StabilityResult*> own;
    for (const StabilityResult& result : results) {
      if (result.study.family.name == family.name) own.push_back(&result);
    }
    ReportSection head{"", family.title, {ReportText{family.about}}, true};
    if (auto map = mapOf(own, family.title, "map_" + family.name)) head.blocks.push_back(*map);
    sections.push_back(std::move(head));
    for (const StabilityResult* result : own) sections.push_back(caseSection(*result));
  }
}

}  // namespace

std::string stabilityWord(const Trace& trace) {
  return trace.isOk() ? "holds" : statusName(trace.status);
}

std::string reproduction(const scenes::StabilityCase& study, const std::vector<std::string>& set,
                         const Trace& trace) {
  std::error_code error;
  const fs::path near = fs::proximate(study.path, error);
  const bool isBelow = !error && !near.empty() && *near.begin() != "..";
  std::string text = "dbd render " + (isBelow ? near.string() : study.path);
  if (!study.variant.empty()) text += " --set stability.variant=" + study.variant;
  for (const std::string& setting : set) text += " --set '" + setting + "'";
  if (trace.failure) {
    const int frame = trace.failure->frame;
    text += fmt::format(" --frames {}:{} --overlays contacts,joints", std::max(0, frame - 1),
                        frame + 2);
  }
  return text;
}

std::string verdictText(const StabilityResult& result) {
  if (!result.stated) {
    return result.problem.empty()
               ? ""
               : fmt::format("FAIL  {:<24} {}\n", result.study.name, result.problem);
  }
  const Trace& trace = *result.stated;
  std::string text = fmt::format("{:<5} {:<24} {}\n", trace.isOk() ? "ok" : "FAIL",
                                 result.study.name, result.study.title);
  for (const TraceVerdict& verdict : trace.verdicts) {
    const std::string margin = verdict.margin();
    text += fmt::format("      {:<5} {}{}  (at {:.4g} s; line {})\n", verdict.holds ? "ok" : "FAIL",
                        verdict.text, margin.empty() ? "" : ": " + margin, verdict.atTime,
                        verdict.line);
  }
  if (trace.verdicts.empty() && trace.isOk()) text += "      states no expectation\n";
  if (trace.isOk()) return text;
  if (!trace.message.empty()) text += "      " + trace.message + "\n";
  if (trace.failure) text += "      " + failureLine(trace) + "\n";
  return text + "      " + reproduction(result.study, {}, trace) + "\n";
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

StudyFindings stabilityFindings(const Results& results, bool searched, const std::string& command,
                                int reused) {
  StudyFindings findings;
  const auto held = std::count_if(results.begin(), results.end(),
                                  [](const StabilityResult& result) { return result.holds(); });
  findings.isGood = held == static_cast<std::ptrdiff_t>(results.size());
  for (const StabilityResult& result : results) findings.text += severityText(result);
  findings.text += fmt::format("{} of {} cases hold", held, results.size());
  if (reused > 0) findings.text += fmt::format("; {} runs were made before", reused);
  findings.text += "\n";
  Report& report = findings.report;
  report.title = "Hard cases stay stable";
  report.command = command;
  report.tables.emplace_back("cases.csv", casesTable(results));
  if (searched) report.tables.emplace_back("severity.csv", severityTable(results));
  report.sections.push_back(
      {"",
       "",
       {ReportText{fmt::format(
           "{} of {} cases hold at their stated level, each with the settings of its family.", held,
           results.size())}},
       true});
  report.sections.push_back(contents(results));
  addFamilies(results, report.sections);
  return findings;
}

}  // namespace app
