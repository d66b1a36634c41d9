// index.html of `dbd study stability`.
#include "app/study/stability_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/build_info.h"
#include "app/base/html.h"
#include "app/base/machine.h"
#include "app/base/output_file.h"
#include "app/study/stability_map.h"

namespace app {

namespace {

namespace fs = std::filesystem;

std::string verdictCell(bool holds) {
  return holds ? "<td class=\"good\">ok</td>" : "<td class=\"bad\">FAIL</td>";
}

// The number that is closest to its bound, or has passed it.
const StabilityVerdict* tightest(const StabilityRun& run) {
  const auto share = [](const StabilityVerdict& v) {
    if (!v.holds || v.bound == 0 || v.value == 0) return v.holds ? 0.0 : 1e300;
    return v.atMost == (v.bound > 0) ? v.value / v.bound : v.bound / v.value;
  };
  const auto most =
      std::max_element(run.verdicts.begin(), run.verdicts.end(),
                       [&](const auto& a, const auto& b) { return share(a) < share(b); });
  return most == run.verdicts.end() ? nullptr : &*most;
}

std::string contents(const std::vector<StabilityResult>& results) {
  std::string html =
      "<section><h2>Cases</h2>\n<table><tr><th></th><th>case</th><th>the tightest number</th>"
      "<th></th></tr>\n";
  for (const StabilityResult& result : results) {
    const StabilityVerdict* verdict = tightest(result.stated);
    html += fmt::format(
        "<tr>{}<td><a href=\"#{}\">{}</a></td><td>{}</td><td>{}</td></tr>\n",
        verdictCell(result.holds()), escapeHtml(result.study.name),
        escapeHtml(result.study.title.empty() ? result.study.name : result.study.title),
        escapeHtml(verdict != nullptr ? verdict->text : result.problem + result.stated.message),
        verdict != nullptr ? escapeHtml(verdict->margin()) : "");
  }
  return html + "</table></section>\n";
}

std::string pictures(const std::vector<StabilityShot>& shots, const fs::path& folder) {
  std::string html;
  for (const StabilityShot& shot : shots) {
    if (!fs::exists(folder / shot.file)) continue;
    html += fmt::format(
        "<figure><img class=\"poster\" src=\"{}\" alt=\"\"><figcaption>{}</figcaption></figure>\n",
        escapeHtml(shot.file), escapeHtml(shot.caption));
  }
  return html.empty() ? "" : "<div class=\"shots\">\n" + html + "</div>\n";
}

std::string expectationTable(const StabilityRun& run) {
  if (run.verdicts.empty()) return "";
  std::string html = "<table><tr><th></th><th>criterion</th><th>margin</th><th>at, s</th></tr>\n";
  for (const StabilityVerdict& verdict : run.verdicts) {
    html += fmt::format("<tr>{}<td>{}</td><td>{}</td><td class=\"number\">{:.4g}</td></tr>\n",
                        verdictCell(verdict.holds), escapeHtml(verdict.text),
                        escapeHtml(verdict.margin()), verdict.atTime);
  }
  return html + "</table>\n";
}

std::string failure(const StabilityResult& result) {
  const StabilityRun& run = result.stated;
  if (run.holds()) return "";
  std::string html =
      run.message.empty() ? "" : "<p class=\"bad\">" + escapeHtml(run.message) + "</p>\n";
  if (run.failure) {
    html +=
        fmt::format("<p><span class=\"bad\">First bad frame {}</span> ({:.4g} s): {}{}</p>\n",
                    run.failure->frame, run.failure->time, escapeHtml(run.failure->what),
                    run.failure->where().empty() ? "" : ", at " + escapeHtml(run.failure->where()));
  }
  return html + "<p><code>" + escapeHtml(reproduction(result.study, {}, run)) + "</code></p>\n";
}

std::string barRow(const StabilityBar& bar) {
  const auto level = [](const std::optional<double>& value) {
    return value ? levelText(*value) : std::string("–");
  };
  std::string where, what;
  if (bar.firstFailure && bar.firstFailure->failure) {
    const StabilityFailure& failure = *bar.firstFailure->failure;
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
  return fmt::format(
      "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td>"
      "<td>{}</td></tr>\n",
      escapeHtml(bar.way.title), level(bar.border.holds), level(bar.border.fails), escapeHtml(what),
      escapeHtml(where));
}

std::string severity(const StabilityResult& result, const fs::path& folder) {
  if (result.bars.empty()) return "";
  const scenes::StabilitySeverity& s = *result.study.severity;
  std::string html = fmt::format(
      "<p>How far it can be pushed: {}{}, stated {}, searched from {} to {}.</p>\n"
      "<table><tr><th>method</th><th>holds to</th><th>fails at</th><th>what fails first</th>"
      "<th>where</th></tr>\n",
      escapeHtml(s.label), s.unit.empty() ? "" : " [" + escapeHtml(s.unit) + "]",
      levelText(s.stated), levelText(s.from), levelText(s.to));
  for (const StabilityBar& bar : result.bars) html += barRow(bar);
  html += "</table>\n";
  for (const StabilityBar& bar : result.bars) {
    const std::string shots = pictures(bar.shots, folder);
    if (shots.empty()) continue;
    html += fmt::format(
        "<details><summary>{} at {}</summary>\n{}<p><code>{}</code></p></details>\n",
        escapeHtml(bar.way.title), levelText(*bar.border.fails), shots,
        escapeHtml(reproduction(result.study, overridesOf(bar.way, s, *bar.border.fails),
                                *bar.firstFailure)));
  }
  return html;
}

std::string caseSection(const StabilityResult& result, const fs::path& folder) {
  std::string html =
      fmt::format("<section id=\"{}\"><h2>{}</h2>\n<p>{}</p>\n", escapeHtml(result.study.name),
                  escapeHtml(result.study.title), escapeHtml(result.study.about));
  if (!result.problem.empty()) {
    return html + "<p class=\"bad\">" + escapeHtml(result.problem) + "</p></section>\n";
  }
  return html + expectationTable(result.stated) + failure(result) +
         pictures(result.failureShots, folder) + pictures(result.shots, folder) +
         severity(result, folder) + "</section>\n";
}

std::string mapFigure(const scenes::StabilityFamily& family, const fs::path& folder) {
  const std::string name = "map_" + family.name;
  if (!fs::exists(folder / (name + ".svg"))) return "";
  return fmt::format(
      "<figure><a href=\"{0}.png\"><img class=\"poster\" src=\"{0}.svg\" alt=\"how far each case "
      "can be pushed\"></a><figcaption>A bar goes as far as the criterion holds; the cross is the "
      "easiest level that failed, with what failed first. Dashed: the stated "
      "level.</figcaption></figure>\n",
      escapeHtml(name));
}

}  // namespace

fs::path writeStabilityPage(const std::vector<StabilityResult>& results, const std::string& command,
                            const fs::path& folder) {
  const auto held = std::count_if(results.begin(), results.end(),
                                  [](const StabilityResult& result) { return result.holds(); });
  std::string body = fmt::format(
      "<h1>Hard cases stay stable</h1>\n<p class=\"quiet\">{}, {} threads; dbd {}, {}.<br><code>{}"
      "</code></p>\n<p>{} of {} cases hold at their stated level, each with the settings of its "
      "family.</p>\n",
      escapeHtml(processorName()), processorCount(), version(), escapeHtml(compiler()),
      escapeHtml(command), held, results.size());
  body += contents(results);
  for (const scenes::StabilityFamily& family : familiesOf(results)) {
    body += fmt::format("<h2>{}</h2>\n<p>{}</p>\n", escapeHtml(family.title),
                        escapeHtml(family.about)) +
            mapFigure(family, folder);
    for (const StabilityResult* result : casesOf(results, family.name)) {
      body += caseSection(*result, folder);
    }
  }
  const fs::path page = folder / "index.html";
  writeFile(page, htmlPage("Hard cases stay stable", body));
  return page;
}

}  // namespace app
