// The accuracy study as a page, tables and lines of text.
#include <fmt/format.h>

#include <algorithm>

#include "app/base/machine.h"
#include "app/base/numbers.h"
#include "app/study/accuracy.h"
#include "app/study/asked.h"
#include "app/study/cheapest.h"
#include "app/study/shots.h"

namespace app {

namespace {

using Look = ReportCell::Look;
using Cases = std::vector<const CaseResults*>;

ReportSection askedSection(const std::vector<AskedPoint>& points) {
  ReportSection section{"asked", "Asked and delivered", {}};
  section.blocks.push_back(
      ReportText{askedText(points) + ". All of them:", Look::kPlain, false, "asked.csv"});
  section.blocks.push_back(askedChart(points));
  ReportTable table{{"case", "asked", "delivered", "estimated, of a step", "reference's own", ""},
                    {},
                    "Not within"};
  for (const AskedPoint& p : points) {
    if (p.verdict == AskedPoint::Verdict::kDelivered) continue;
    const bool isUnjudged = p.verdict == AskedPoint::Verdict::kUnjudged;
    table.rows.push_back(
        {{p.study, Look::kPlain, p.study},
         number(accuracyText(p.asked)),
         number(p.point->isOk() ? numberText(p.delivered) : statusName(p.point->status)),
         number(p.point->estimate > 0 ? numberText(p.point->estimate) : "none"),
         number(numberText(p.reference)),
         {isUnjudged ? "the reference is no better than what was asked" : p.point->message,
          Look::kQuiet}});
  }
  if (!table.rows.empty()) section.blocks.push_back(std::move(table));
  return section;
}

ReportSection contents(const Cases& cases) {
  ReportTable table{
      {"case", "cheapest of ours to 1 %", "against other engines, to 1 %", "to 0.1 %"}, {}, ""};
  Cases measured;
  for (const CaseResults* results : cases) {
    if (!results->problem.empty()) continue;
    measured.push_back(results);
    const std::vector<CheapestRow> rows = cheapestRows(*results);
    const auto cell = [](const CheapestRow& row) {
      return ReportCell{row.verdict, row.oursWins ? Look::kPlain : Look::kBad};
    };
    const Trace* ours = rows[0].ours;
    table.rows.push_back({{results->study.title, Look::kPlain, results->study.name},
                          {ours == nullptr ? "not reached"
                                           : fmt::format("{} per s, {}", secondsText(ours->cost()),
                                                         results->methodTitle(*ours))},
                          cell(rows[0]),
                          cell(rows[1])});
  }
  return {"cases", "Cases", {std::move(table), ReportText{goalsText(measured) + "."}}};
}

std::string busyRemark(const Cases& cases) {
  int busy = 0;
  double load = 0;
  for (const CaseResults* results : cases) {
    busy += results->wasBusy() ? 1 : 0;
    for (const Trace& point : results->points) load = std::max(load, point.load);
  }
  if (busy == 0) return "";
  return fmt::format(
      "The machine was busy while {} of {} cases were measured (load average up to {:.1f} on {} "
      "cores). Where other programs took the processor in every repeat, the time that a run had on "
      "it stands in for its wall time. Errors and constraint evaluations do not depend on it.",
      busy, cases.size(), load, processorCount());
}

constexpr const char* kHowMeasured =
    "How this was measured: each point simulates a whole case with one method and one step, or by "
    "one accuracy that the method is asked for. Its time is what the steps took, the least of the "
    "repeats, per simulated second; measuring is not in it. Points were measured one after the "
    "other. Real time is one second per simulated second: 1/60 s for a frame of 1/60 s. The error "
    "is the distance from the reference that each case names; 100 % is the case's scale. The order "
    "of convergence is the slope of a line through log error against log h, by least squares, in "
    "the range where the error falls with the step. Small marks are points that another of the "
    "same method beats in time and error. Marks in the strip at the top failed: numbers that are "
    "not finite, an error beyond 1000 times the scale, or given up as too slow. Constraint "
    "evaluations are a cost that no busy machine changes; other engines do not report it. Every "
    "number:";

std::string referenceText(const CaseResults& results) {
  std::string text = "Reference: " + results.reference.what;
  if (results.reference.accuracy) {
    text += fmt::format(", its own error about {} {}", numberText(*results.reference.accuracy),
                        results.study.unit);
  }
  text += fmt::format(". 100 % is {:g} {}.", results.study.scale, results.study.unit);
  if (results.study.trustedUntil) {
    text += fmt::format(
        " The motion is chaotic: trajectories are compared up to {:g} s, beyond that only "
        "statistics are.",
        *results.study.trustedUntil);
  }
  std::string published;
  for (const scenes::StudyPublished& p : results.study.published) {
    published +=
        fmt::format("{}{} {} at h = {} s", published.empty() ? " Published by others: " : "; ",
                    p.label, numberText(p.error), numberText(p.h));
  }
  return text + published;
}

ReportTable cheapestTable(const CaseResults& results) {
  const auto reached = [&](const Trace* point) -> ReportCell {
    if (point == nullptr) return {"not reached", Look::kQuiet};
    std::string step = stepText(*point);
    if (point->h > 0) step += ", " + point->key.text();
    return {fmt::format("{} per s: {}, {}", secondsText(point->cost()), results.methodTitle(*point),
                        step)};
  };
  const std::vector<CheapestRow> rows = cheapestRows(results);
  ReportTable table{{"cheapest way to", "ours"}, {}, ""};
  for (const auto& peer : rows.front().peers) table.heads.push_back(results.titleOf(peer.method));
  table.heads.emplace_back();
  for (const CheapestRow& row : rows) {
    std::vector<ReportCell> cells{{percentText(row.target)}, reached(row.ours)};
    for (const CheapestRow::PeerPoint& peer : row.peers) cells.push_back(reached(peer.point));
    cells.emplace_back(row.verdict, row.oursWins ? Look::kQuiet : Look::kBad);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

// A step where the method has one, else the accuracy that it was asked for.
std::string fineness(const Trace& point) {
  return point.h > 0 ? numberText(point.h) : point.key.text();
}

std::string remark(const MethodRow& row) {
  std::string text = row.refusal;
  if (row.failed > 0) text += fmt::format("{} failed", row.failed);
  if (row.skipped > 0) {
    text += fmt::format("{}{} not measured: too long", text.empty() ? "" : ", ", row.skipped);
  }
  return text;
}

ReportTable methodTable(const CaseResults& results) {
  ReportTable table{{"method", "order", "least error", "at h, s", "time per s", "joints open, m",
                     "overlap, m", "energy drift", "momentum drift", ""},
                    {},
                    ""};
  for (const MethodRow& row : methodRows(results)) {
    std::vector<ReportCell> cells{{results.titleOf(row.method)}};
    if (row.best == nullptr) {
      cells.resize(9);
    } else {
      const Trace& best = *row.best;
      const std::string order = best.h == 0 ? "it chooses"
                                : !row.order
                                    ? "too few points below 30 % of the scale"
                                    : fmt::format("{:.2f} ± {:.2f}, {} points", row.order->order,
                                                  row.order->deviation, row.order->points);
      cells.emplace_back(order, row.order ? Look::kPlain : Look::kQuiet);
      for (const std::string& text :
           {numberText(best.errors.error), fineness(best), secondsText(best.cost()),
            numberText(best.worst.residual), numberText(best.worst.overlap),
            numberText(best.worst.energyDrift), numberText(best.worst.momentumDrift)}) {
        cells.push_back(number(text));
      }
    }
    cells.emplace_back(remark(row), Look::kQuiet);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

// None: interrupted.
std::optional<ReportSection> caseSection(const CaseResults& results,
                                         const std::filesystem::path& folder) {
  ReportSection section{results.study.name, results.study.title, {ReportText{results.study.about}}};
  auto& blocks = section.blocks;
  if (!results.problem.empty()) {
    blocks.push_back(ReportText{results.problem, Look::kBad});
    return section;
  }
  blocks.push_back(ReportText{referenceText(results), Look::kQuiet});
  if (results.best() != nullptr) {
    blocks.push_back(timeChart(results));
    if (auto chart = stepChart(results)) blocks.push_back(std::move(*chart));
  }
  blocks.push_back(cheapestTable(results));
  ReportShots shots;
  const std::vector<StudyShot> chosen = chooseShots(results);
  if (!drawShots(results, chosen, folder)) return std::nullopt;
  for (const StudyShot& shot : chosen) shots.files.emplace_back(shot.file, shot.caption);
  if (!chosen.empty()) {
    blocks.push_back(ReportText{fmt::format("The state after {:g} s:", results.study.duration)});
    blocks.push_back(std::move(shots));
  }
  blocks.push_back(methodTable(results));
  blocks.push_back(ReportText{fmt::format("dbd study accuracy {} --fresh", results.study.name),
                              Look::kQuiet, true});
  return section;
}

// What all cases say together, in front of them.
void addTotals(const Cases& cases, const Cases& measured, StudyFindings& findings) {
  Report& report = findings.report;
  const Glance glance = glanceAt(measured);
  ReportSection first{"glance", "At a glance", {}};
  if (glance.chart) first.blocks.push_back(*glance.chart);
  for (const std::string& sentence : glance.sentences) {
    first.blocks.push_back(ReportText{sentence});
    findings.text += sentence + "\n";
  }
  if (!first.blocks.empty()) report.sections.push_back(std::move(first));
  const std::vector<AskedPoint> asked = askedPoints(measured);
  if (!asked.empty()) {
    report.tables.emplace_back("asked.csv", askedTable(asked));
    report.sections.push_back(askedSection(asked));
    findings.text += askedText(asked) + "\n";
  }
  findings.text += goalsText(measured) + "\n";
  report.sections.push_back(contents(cases));
  ReportSection how{"", "", {ReportText{kHowMeasured, Look::kQuiet, false, "points.csv"}}, true};
  if (const std::string busy = busyRemark(cases); !busy.empty()) {
    how.blocks.insert(how.blocks.begin(), ReportText{busy, Look::kBad});
  }
  report.sections.push_back(std::move(how));
}

}  // namespace

std::optional<StudyFindings> accuracyFindings(const Cases& cases, const std::string& command,
                                              const std::filesystem::path& folder) {
  StudyFindings findings;
  findings.report.title = "What accuracy costs in time";
  findings.report.command = command;
  Cases measured;
  std::vector<Trace> points;
  for (const CaseResults* results : cases) {
    const bool isMeasured = results->problem.empty();
    findings.isGood = findings.isGood && isMeasured;
    findings.text += isMeasured ? summaryText(*results) : results->problem + "\n";
    if (isMeasured) measured.push_back(results);
    points.insert(points.end(), results->points.begin(), results->points.end());
  }
  findings.report.tables.emplace_back("points.csv", pointsTable(points));
  addTotals(cases, measured, findings);
  for (const CaseResults* results : cases) {
    auto section = caseSection(*results, folder);
    if (!section) return std::nullopt;
    findings.report.sections.push_back(std::move(*section));
  }
  return findings;
}

}  // namespace app
