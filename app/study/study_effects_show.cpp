// What was measured of a scene's effects, as text, HTML and a bar picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/html.h"
#include "app/study/study_effects.h"
#include "app/study/study_frame.h"
#include "app/study/study_table.h"

namespace app {

namespace {

using Kind = EffectTrial::Kind;

std::string titleOf(const EffectTrial& trial) {
  return trial.kind == Kind::kWithout ? "without " + trial.name : trial.name;
}

// What the scene as it is saves of a row that does more, or what leaving an effect out saves of it.
double shareOf(const EffectResults& results, const EffectRow& row) {
  const double whole = results.asItIs().processor;
  if (row.trial.kind != Kind::kWithout) return results.saved(row.point);
  return whole > 0 ? 1 - row.point.processor / whole : 0;
}

double noiseOf(const EffectResults& results, const EffectRow& row) {
  const double whole = results.asItIs().processor;
  if (row.trial.kind != Kind::kWithout) return results.noise(row.point);
  const double ratio = whole > 0 ? row.point.processor / whole : 0;
  return ratio * std::hypot(row.point.wallSpread, results.asItIs().wallSpread);
}

std::string stepText(const EffectResults& results, const StudyPoint& point) {
  return point.repeats > 0 ? secondsText(point.processor / results.fps) : "–";
}

std::string savedText(const EffectResults& results, const EffectRow& row) {
  if (row.point.repeats == 0) return "–";
  return fmt::format("{:.0f} ± {:.0f} %", 100 * shareOf(results, row), 100 * noiseOf(results, row));
}

std::string outcomeText(const StudyPoint& point) {
  if (!point.isOk()) return fmt::format("{}: {}", statusName(point.status), point.message);
  return point.message.empty() ? "" : "fails: " + point.message;
}

std::string energyText(const StudyPoint& point) {
  return fmt::format("{:+.2g} J", point.worst.energyDrift);
}

std::string tableRow(const EffectResults& results, const EffectRow& row) {
  const StudyPoint& p = row.point;
  const bool isFirst = row.trial.kind == Kind::kAsItIs;
  const auto number = [](const std::string& text) {
    return "<td class=\"number\">" + escapeHtml(text) + "</td>";
  };
  return fmt::format("<tr><td>{}</td>{}{}{}{}{}<td>{}</td></tr>\n", escapeHtml(titleOf(row.trial)),
                     number(stepText(results, p)), number(isFirst ? "" : savedText(results, row)),
                     number(fmt::format("{:.4g}", p.evaluations / results.fps)),
                     number(isFirst || !p.isOk() ? "" : numberText(p.errors.error) + " m"),
                     number(isFirst || !p.isOk() ? "" : energyText(p)), escapeHtml(outcomeText(p)));
}

std::string staysText(const EffectResults& results) {
  std::string text;
  for (const scenes::Effect& e : results.effects) {
    if (!e.on || e.stays.empty() || e.part == scenes::EffectPart::kPictures) continue;
    text +=
        fmt::format("{}{}: {}", text.empty() ? "" : "; ", escapeHtml(e.name), escapeHtml(e.stays));
  }
  return text.empty() ? "" : "<p class=\"quiet\">Not taken out: " + text + ".</p>\n";
}

std::string leftOutText(const EffectResults& results) {
  std::string text;
  for (const scenes::Effect& e : results.effects) {
    if (!e.leftOut) continue;
    text +=
        fmt::format("{}{} ({})", text.empty() ? "" : "; ", escapeHtml(e.name), escapeHtml(e.why));
  }
  return text.empty() ? "" : "<p class=\"quiet\">Left out by the program: " + text + ".</p>\n";
}

}  // namespace

std::string listText(const std::vector<scenes::Effect>& effects) {
  std::string text;
  for (const scenes::Effect& e : effects) {
    if (e.on && e.part != scenes::EffectPart::kPictures)
      text += (text.empty() ? "" : ", ") + e.name;
  }
  return text;
}

std::string effectsText(const EffectResults& results) {
  std::string text = fmt::format("{}: {}\n", results.name, results.title);
  for (const EffectRow& row : results.rows) {
    const bool isFirst = row.trial.kind == Kind::kAsItIs;
    text += fmt::format("  {:<28} {:>9} a step", titleOf(row.trial), stepText(results, row.point));
    if (!isFirst && row.point.repeats > 0) {
      text += fmt::format(
          "{}{}; {} m off, energy {}", row.trial.kind == Kind::kWithout ? ", saves " : ", spared ",
          savedText(results, row), numberText(row.point.errors.error), energyText(row.point));
    }
    const std::string outcome = outcomeText(row.point);
    text += outcome.empty() ? "\n" : "\n      " + outcome + "\n";
  }
  return text;
}

std::string effectsSection(const EffectResults& results, bool plotted) {
  const std::string name = escapeHtml(results.name);
  std::string html =
      fmt::format("<section id=\"{}\"><h2>{}</h2>\n<p class=\"quiet\">{}: {}.</p>\n", name,
                  escapeHtml(results.title), name, escapeHtml(listText(results.effects)));
  if (plotted) {
    html += fmt::format(
        "<figure><a href=\"{0}.png\"><img class=\"poster\" src=\"{0}.svg\" alt=\"what leaving each "
        "effect out saves\"></a></figure>\n",
        name);
  }
  html +=
      "<table><tr><th></th><th>a step</th><th>saved</th><th>evaluations a step</th><th>bodies are "
      "off by (rms)</th><th>energy is off by</th><th></th></tr>\n";
  for (const EffectRow& row : results.rows) html += tableRow(results, row);
  return html + "</table>\n" + staysText(results) + leftOutText(results) + "</section>\n";
}

std::string effectsRow(const EffectResults& results) {
  const EffectRow* everything = results.find(Kind::kEverythingOn);
  const bool known = everything != nullptr && everything->point.repeats > 0;
  return fmt::format("| `{}` | {} | {:.2g} | {} |\n", results.name, listText(results.effects),
                     1e3 * results.asItIs().processor / results.fps,
                     known ? fmt::format("{:.0f} %", 100 * results.saved(everything->point)) : "–");
}

std::string effectsScript(const EffectResults& results) {
  std::string data, labels;
  int count = 0;
  double low = 0, high = 0;
  for (const EffectRow& row : results.rows) {
    if (row.trial.kind == Kind::kAsItIs || row.point.repeats == 0) continue;
    const double share = 100 * shareOf(results, row), noise = 100 * noiseOf(results, row);
    const bool isWithout = row.trial.kind == Kind::kWithout;
    data += fmt::format("\"{}\" {} {:.6g} {:.6g} {}\n", plotText(titleOf(row.trial)), count, share,
                        noise, isWithout ? "0x0072b2" : "0xd55e00");
    labels += fmt::format("set label \"{:.0f} %\" at {:.6g},{} {} offset {},0 font ',10'\n", share,
                          share >= 0 ? share + noise : share - noise, count,
                          share >= 0 ? "left" : "right", share >= 0 ? 0.6 : -0.6);
    low = std::min(low, share - noise);
    high = std::max(high, share + noise);
    ++count;
  }
  const double span = std::max(high - low, 10.0);
  const std::string plot = fmt::format(
      "$bars << EOD\n{}EOD\n{}"
      "plot $bars using 3:2:(0):3:($2-0.34):($2+0.34):5:ytic(1) with boxxyerror fs solid 1 "
      "noborder "
      "lc rgb variable notitle, \\\n"
      "  $bars using 3:2:4 with xerrorbars pt 0 lw 1.4 lc rgb '#303030' notitle\n",
      data, labels);
  return fmt::format(
             "# {0}. Drawn by: gnuplot THIS_FILE\n"
             "set title \"{1}: what is saved of a step's time\" font ',13' offset 0,-0.4\n"
             "set xlabel \"[%]  blue: by leaving the effect out;  orange: by what the program "
             "leaves "
             "out\" font ',10'\n"
             "set xrange [{2:.6g}:{3:.6g}]\nset yrange [{4:.6g}:-0.6]\n"
             "set border 1 lw 1 lc rgb '#404040'\nset xtics nomirror out scale 0.7\n"
             "set ytics nomirror scale 0\nset grid xtics lc rgb '#ececec' lw 1 lt 1\n"
             "set arrow from 0,graph 0 to 0,graph 1 nohead lw 1 lc rgb '#404040'\n"
             "set lmargin at screen 0.24\nset rmargin at screen 0.97\n",
             results.name, plotText(results.title), low < 0 ? low - 0.12 * span : 0,
             high + 0.12 * span, count - 0.4) +
         endPlot(results.name, plot);
}

}  // namespace app
