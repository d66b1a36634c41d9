// A case's diagrams, pictures and tables as HTML.
#include "app/study/study_section.h"

#include <fmt/format.h>

#include <cmath>

#include "app/base/html.h"
#include "app/study/study_frame.h"

namespace app {

namespace {

std::string titleInHtml(const StudyResults& results, int method) {
  return escapeHtml(results.study.methods[static_cast<std::size_t>(method)].title);
}

std::string referenceText(const StudyResults& results) {
  std::string text = "Reference: " + escapeHtml(results.reference.what);
  if (results.reference.accuracy) {
    text += fmt::format(", its own error about {} {}", numberText(*results.reference.accuracy),
                        escapeHtml(superscript(results.study.unit)));
  }
  text += fmt::format(". 100 % is {:g} {}.", results.study.scale,
                      escapeHtml(superscript(results.study.unit)));
  if (results.study.trustedUntil) {
    text += fmt::format(
        " The motion is chaotic: trajectories are compared up to {:g} s, beyond that only "
        "statistics are.",
        *results.study.trustedUntil);
  }
  return "<p class=\"quiet\">" + text + "</p>\n";
}

std::string diagram(const std::string& name, const std::string& alt) {
  return fmt::format(
      "<figure><a href=\"{0}.png\"><img class=\"poster\" src=\"{0}.svg\" "
      "alt=\"{1}\"></a></figure>\n",
      name, alt);
}

std::string publishedText(const StudyResults& results) {
  std::string text;
  for (const scenes::StudyPublished& published : results.study.published) {
    text +=
        fmt::format("{}{} {} at h = {} s", text.empty() ? "" : "; ", escapeHtml(published.label),
                    numberText(published.error), numberText(published.h));
  }
  return text.empty() ? "" : "<p class=\"quiet\">Published by others: " + text + ".</p>\n";
}

std::string diagrams(const StudyChapter& chapter) {
  if (!chapter.plotted) return "";
  const std::string name = escapeHtml(chapter.results->study.name);
  std::string html = diagram(name, "error against time");
  if (chapter.results->hasSteps()) html += diagram(name + "_h", "error against the step");
  return html + publishedText(*chapter.results);
}

std::string pictures(const StudyChapter& chapter) {
  if (chapter.shots.empty()) return "";
  std::string html = fmt::format("<p>The state after {:g} s:</p>\n<div class=\"shots\">\n",
                                 chapter.results->study.duration);
  for (const StudyShot& shot : chapter.shots) {
    html += fmt::format(
        "<figure><img class=\"poster\" src=\"{}\" alt=\"\"><figcaption>{}</figcaption></figure>\n",
        escapeHtml(shot.file), escapeHtml(shot.caption));
  }
  return html + "</div>\n";
}

std::string reached(const StudyResults& results, const StudyPoint* point) {
  if (point == nullptr) return "<span class=\"quiet\">not reached</span>";
  std::string step = stepText(*point);
  if (point->h > 0) step += ", " + point->key.text();
  return escapeHtml(fmt::format("{} per s: {}, {}", secondsText(point->cost()),
                                results.methodTitle(*point), step));
}

std::string cheapestTable(const StudyResults& results) {
  const std::vector<CheapestRow> rows = cheapestRows(results);
  std::string html = "<table><tr><th>cheapest way to</th><th>ours</th>";
  for (const CheapestRow::PeerPoint& peer : rows.front().peers) {
    html += "<th>" + titleInHtml(results, peer.method) + "</th>";
  }
  html += "<th></th></tr>\n";
  for (const CheapestRow& row : rows) {
    html += fmt::format("<tr><td>{}</td><td>{}</td>", percentText(row.target),
                        reached(results, row.ours));
    for (const CheapestRow::PeerPoint& peer : row.peers) {
      html += "<td>" + reached(results, peer.point) + "</td>";
    }
    html += fmt::format("<td class=\"{}\">{}</td></tr>\n", row.oursWins ? "quiet" : "bad",
                        escapeHtml(row.verdict));
  }
  return html + "</table>\n";
}

// A step where the method has one, else the accuracy that it was asked for.
std::string fineness(const StudyPoint& point) {
  return point.h > 0 ? numberText(point.h) : point.key.text();
}

std::string orderCell(const StudyPoint& best, const std::optional<OrderFit>& fit) {
  if (best.h == 0) return "<td class=\"quiet\">it chooses</td>";
  if (!fit) return "<td class=\"quiet\">no range converges</td>";
  return fmt::format("<td>{:.2f} ± {:.2f}, {} points</td>", fit->order, fit->deviation,
                     fit->points);
}

std::string remarkCell(const MethodRow& row) {
  std::string text = escapeHtml(row.refusal);
  if (row.failed > 0) text += fmt::format("{} failed", row.failed);
  if (row.skipped > 0) {
    text += fmt::format("{}{} not measured: too long", text.empty() ? "" : ", ", row.skipped);
  }
  return "<td class=\"quiet\">" + text + "</td>";
}

std::string methodTable(const StudyResults& results) {
  std::string html =
      "<table><tr><th>method</th><th>order</th><th>least error</th><th>at h, s</th><th>time per "
      "s</th><th>joints open, m</th><th>overlap, m</th><th>energy drift</th><th>momentum "
      "drift</th><th></th></tr>\n";
  for (const MethodRow& row : methodRows(results)) {
    html += "<tr><td>" + titleInHtml(results, row.method) + "</td>";
    if (row.best == nullptr) {
      html += "<td></td><td></td><td></td><td></td><td></td><td></td><td></td><td></td>";
    } else {
      const StudyPoint& best = *row.best;
      html += orderCell(best, row.order);
      for (const std::string& text :
           {numberText(best.errors.error), fineness(best), secondsText(best.cost()),
            numberText(best.worst.residual), numberText(best.worst.overlap),
            numberText(best.worst.energyDrift), numberText(best.worst.momentumDrift)}) {
        html += "<td class=\"number\">" + text + "</td>";
      }
    }
    html += remarkCell(row) + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string pointRow(const StudyResults& results, const StudyPoint& point) {
  std::string html =
      fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>", escapeHtml(results.methodTitle(point)),
                  point.key.text(), point.isOk() ? "ok" : statusName(point.status));
  for (const std::string& text :
       {fineness(point), numberText(point.errors.error), numberText(point.errors.last),
        numberText(point.worst.residual), numberText(point.worst.overlap),
        numberText(point.worst.energyDrift), secondsText(point.cost()), secondsText(point.wall),
        secondsText(point.wallMedian), fmt::format("{:.0f} %", 100 * point.wallSpread),
        fmt::format("{}", point.repeats), numberText(point.evaluations), numberText(point.restarts),
        numberText(point.fallbacks)}) {
    html += "<td class=\"number\">" + text + "</td>";
  }
  return html + "<td class=\"quiet\">" + escapeHtml(point.message) + "</td></tr>\n";
}

std::string pointTable(const StudyResults& results) {
  std::string html =
      "<details><summary>All points</summary>\n<table><tr><th>method</th><th>steps</th><th></th>"
      "<th>h, s</th><th>error</th><th>at the end</th><th>joints, m</th><th>overlap, m</th>"
      "<th>energy</th><th>time per "
      "s</th><th>wall</th><th>median</th><th>spread</th><th>repeats</th>"
      "<th>evaluations per s</th><th>restarts per s</th><th>fallbacks per s</th><th></th></tr>\n";
  for (const StudyPoint& point : results.points) html += pointRow(results, point);
  return html + "</table></details>\n";
}

}  // namespace

std::string caseSection(const StudyChapter& chapter) {
  const StudyResults& results = *chapter.results;
  std::string html =
      fmt::format("<section id=\"{}\"><h2>{}</h2>\n<p>{}</p>\n", escapeHtml(results.study.name),
                  escapeHtml(results.study.title), escapeHtml(results.study.about));
  if (!chapter.problem.empty()) {
    return html + "<p class=\"bad\">" + escapeHtml(chapter.problem) + "</p></section>\n";
  }
  html += referenceText(results) + diagrams(chapter) + cheapestTable(results);
  html += pictures(chapter) + methodTable(results) + pointTable(results);
  html += fmt::format("<p class=\"quiet\"><code>dbd study accuracy {} --fresh</code></p>\n",
                      escapeHtml(results.study.name));
  return html + "</section>\n";
}

}  // namespace app
