// The page of `dbd study accuracy`.
#include "app/study/study_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/build_info.h"
#include "app/base/html.h"
#include "app/base/machine.h"
#include "app/base/output_file.h"
#include "app/peers/peer.h"
#include "app/study/study_asked.h"
#include "app/study/study_section.h"

namespace app {

namespace {

std::string machineText() {
  std::string text = fmt::format("{}, {} threads; dbd {}, {}", processorName(), processorCount(),
                                 version(), compiler());
  for (const PeerEngine& engine : peerEngines()) {
    text += engine.version.empty() ? fmt::format("; {} was not there when dbd was built ({})",
                                                 engine.name, engine.package)
                                   : fmt::format("; {} {}", engine.name, engine.version);
  }
  return text;
}

std::string busyRemark(const std::vector<StudyChapter>& chapters) {
  int busy = 0;
  double load = 0;
  for (const StudyChapter& chapter : chapters) {
    busy += chapter.results->wasBusy() ? 1 : 0;
    for (const StudyPoint& point : chapter.results->points) load = std::max(load, point.load);
  }
  if (busy == 0) return "";
  return fmt::format(
      "<p><span class=\"bad\">The machine was busy</span> while {} of {} cases were measured (load "
      "average up to {:.1f} on {} cores). Where other programs took the processor in every repeat, "
      "the "
      "time that a run had on it stands in for its wall time. Errors and constraint evaluations do "
      "not depend on it.</p>\n",
      busy, chapters.size(), load, processorCount());
}

std::string askedRow(const AskedPoint& p) {
  const std::string delivered =
      p.point->isOk() ? numberText(p.delivered) : escapeHtml(statusName(p.point->status));
  return fmt::format(
      "<tr><td><a href=\"#{0}\">{0}</a></td><td class=\"number\">{1}</td><td "
      "class=\"number\">{2}</td><td class=\"number\">{3}</td><td class=\"number\">{4}</td>"
      "<td class=\"quiet\">{5}</td></tr>\n",
      escapeHtml(p.study), accuracyText(p.asked), delivered,
      p.point->estimate > 0 ? numberText(p.point->estimate) : "none", numberText(p.reference),
      p.verdict == AskedPoint::Verdict::kUnjudged ? "the reference is no better than what was asked"
                                                  : escapeHtml(p.point->message));
}

std::string askedSection(const std::vector<AskedPoint>& points, bool plotted) {
  if (points.empty()) return "";
  std::string html = "<section><h2>Asked and delivered</h2>\n<p>" + askedText(points) +
                     ". <a href=\"asked.csv\">asked.csv</a> has them all.</p>\n";
  if (plotted) {
    html +=
        "<figure><a href=\"asked.png\"><img class=\"poster\" src=\"asked.svg\" alt=\"accuracy "
        "delivered over accuracy asked for\"></a><figcaption>Those that were asked for the same "
        "stand beside each other in the order of the cases.</figcaption></figure>\n";
  }
  std::string rows;
  for (const AskedPoint& point : points) {
    if (point.verdict != AskedPoint::Verdict::kDelivered) rows += askedRow(point);
  }
  if (!rows.empty()) {
    html +=
        "<p>Not within:</p>\n<table><tr><th>case</th><th>asked</th><th>delivered</th>"
        "<th>estimated, of a step</th><th>reference's own</th><th></th></tr>\n" +
        rows + "</table>\n";
  }
  return html + "</section>\n";
}

std::string contents(const std::vector<StudyChapter>& chapters) {
  std::string html =
      "<section><h2>Cases</h2>\n<table><tr><th>case</th><th>cheapest of ours to 1 "
      "%</th><th>against "
      "other engines, to 1 %</th><th>to 0.1 %</th></tr>\n";
  for (const StudyChapter& chapter : chapters) {
    const StudyResults& results = *chapter.results;
    const std::vector<CheapestRow> rows = cheapestRows(results);
    const auto cell = [](const CheapestRow& row) {
      return fmt::format("<td class=\"{}\">{}</td>", row.oursWins ? "" : "bad",
                         escapeHtml(row.verdict));
    };
    const StudyPoint* ours = rows[0].ours;
    html += fmt::format("<tr><td><a href=\"#{}\">{}</a></td><td>{}</td>{}{}</tr>\n",
                        escapeHtml(results.study.name), escapeHtml(results.study.title),
                        ours == nullptr
                            ? "not reached"
                            : escapeHtml(fmt::format("{} per s, {}", secondsText(ours->cost()),
                                                     results.methodTitle(*ours))),
                        cell(rows[0]), cell(rows[1]));
  }
  return html + "</table>\n<p>" + escapeHtml(goalsText(resultsOf(chapters))) + ".</p></section>\n";
}

constexpr const char* kHowMeasured =
    "<details><summary>How this was measured</summary>\n<p>Each point simulates a whole case with "
    "one method and one step, or by one accuracy that the method is asked for. Its time is what "
    "the steps took, the least of the "
    "repeats, per simulated second; measuring is not in it. Points were measured one after "
    "the other. "
    "<em>Real time</em> is one second per simulated second: 1/60 s for a frame of 1/60 s. The "
    "error is the distance from the reference that each case names; 100 % is the case's scale. The "
    "order of convergence is the slope of a line through log error against log h, by least "
    "squares, "
    "in the range where the error falls with the step. Small marks are points that another of the "
    "same method beats in time and error. Marks in the strip at the top failed: numbers that are "
    "not finite, an error beyond 1000 times the scale, or given up as too slow. Constraint "
    "evaluations are a cost that no busy machine changes; other engines do not report it. "
    "<a href=\"points.csv\">points.csv</a> has every number.</p></details>\n";

}  // namespace

std::vector<const StudyResults*> resultsOf(const std::vector<StudyChapter>& chapters) {
  std::vector<const StudyResults*> results;
  for (const StudyChapter& chapter : chapters) {
    if (chapter.problem.empty()) results.push_back(chapter.results);
  }
  return results;
}

std::filesystem::path writeStudyPage(const std::vector<StudyChapter>& chapters,
                                     const std::string& command,
                                     const std::filesystem::path& folder) {
  const std::vector<AskedPoint> asked = askedPoints(resultsOf(chapters));
  if (!asked.empty()) writeFile(folder / "asked.csv", askedTable(asked));
  const bool plotted = std::any_of(chapters.begin(), chapters.end(),
                                   [](const StudyChapter& chapter) { return chapter.plotted; });
  std::string body = "<h1>What accuracy costs in time</h1>\n<p class=\"quiet\">" +
                     escapeHtml(machineText()) + ".<br><code>" + escapeHtml(command) +
                     "</code></p>\n" + askedSection(asked, plotted) + busyRemark(chapters) +
                     kHowMeasured;
  if (!chapters.empty()) body += contents(chapters);
  for (const StudyChapter& chapter : chapters) body += caseSection(chapter);
  const std::filesystem::path page = folder / "index.html";
  writeFile(page, htmlPage("What accuracy costs in time", body));
  return page;
}

}  // namespace app
