// What was measured of a scene's effects, as text, a table and bars.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/numbers.h"
#include "app/study/effects.h"

namespace app {

namespace {

using Kind = EffectTrial::Kind;
using Look = ReportCell::Look;

std::string titleOf(const EffectTrial& trial) {
  return trial.kind == Kind::kWithout ? "without " + trial.name : trial.name;
}

std::string ofStep(const EffectResults& results, const Trace& trace) {
  return trace.repeats > 0 ? secondsText(trace.processor / results.fps) : "–";
}

std::string savedText(const EffectResults& results, const EffectRow& row) {
  if (row.trace.repeats == 0) return "–";
  return fmt::format("{:.0f} ± {}", std::round(100 * results.saved(row)) + 0.0,  // no -0
                     wholePercentText(results.noise(row)));
}

std::string outcomeText(const Trace& trace) {
  if (!trace.isOk()) return fmt::format("{}: {}", statusName(trace.status), trace.message);
  return trace.message.empty() ? "" : "fails: " + trace.message;
}

std::string energyText(const Trace& trace) {
  return fmt::format("{:+.2g} J", trace.worst.energyDrift);
}

ReportTable tableOf(const EffectResults& results) {
  ReportTable table{{"", "a step", "saved", "evaluations a step", "bodies are off by (rms)",
                     "energy is off by", ""},
                    {},
                    ""};
  for (const EffectRow& row : results.rows) {
    const Trace& t = row.trace;
    const bool isFirst = row.trial.kind == Kind::kAsItIs;
    const bool compares = !isFirst && t.isOk();
    table.rows.push_back({{titleOf(row.trial)},
                          number(ofStep(results, t)),
                          number(isFirst ? "" : savedText(results, row)),
                          number(fmt::format("{:.4g}", t.evaluations / results.fps)),
                          number(compares ? numberText(t.errors.error) + " m" : ""),
                          number(compares ? energyText(t) : ""),
                          {outcomeText(t)}});
  }
  return table;
}

// "Not taken out: rotation: ...; ...", of the effects that `counts` gives words for.
template <class Words>
void addList(const EffectResults& results, const std::string& head, Words wordsOf,
             ReportSection& section) {
  std::string text;
  for (const scenes::Effect& e : results.effects) {
    const std::string words = wordsOf(e);
    if (!words.empty()) text += (text.empty() ? "" : "; ") + words;
  }
  if (!text.empty()) section.blocks.push_back(ReportText{head + text + ".", Look::kQuiet});
}

void addBar(const EffectResults& results, const EffectRow& row, double y, Chart& chart) {
  constexpr double kHalf = 0.34;
  const double share = 100 * results.saved(row), noise = 100 * results.noise(row);
  const double end = share >= 0 ? share + noise : share - noise;
  chart.boxes.push_back({{std::min(0.0, share), y - kHalf},
                         {std::max(0.0, share), y + kHalf},
                         row.trial.kind == Kind::kWithout ? "#0072b2" : "#d55e00"});
  chart.lines.push_back({{share - noise, y}, {share + noise, y}, "#303030", "", 1.4});
  chart.labels.push_back(
      {{end, y}, " " + wholePercentText(share / 100) + " ", share >= 0 ? 'l' : 'r'});
  chart.y.ticks.emplace_back(y, titleOf(row.trial));
  chart.x.low = std::min(chart.x.low, share - noise);
  chart.x.high = std::max(chart.x.high, share + noise);
}

Chart chartOf(const EffectResults& results) {
  Chart chart{.name = results.name, .title = results.title + ": what is saved of a step's time"};
  chart.alt = "what leaving each effect out saves";
  chart.x.title = "[%]  blue: by leaving the effect out;  orange: by what the program leaves out";
  chart.x.high = 10;
  chart.left = 0.24;
  chart.right = 0.97;
  double y = 0;
  for (const EffectRow& row : results.rows) {
    if (row.trial.kind != Kind::kAsItIs && row.trace.repeats > 0) addBar(results, row, y++, chart);
  }
  const double span = chart.x.high - chart.x.low;
  if (chart.x.low < 0) chart.x.low -= 0.12 * span;
  chart.x.high += 0.12 * span;
  chart.y.low = -0.6;
  chart.y.high = y - 0.4;
  chart.y.reversed = true;
  chart.lines.push_back({{0, chart.y.low}, {0, chart.y.high}});
  return chart;
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
    text += fmt::format("  {:<28} {:>9} a step", titleOf(row.trial), ofStep(results, row.trace));
    if (!isFirst && row.trace.repeats > 0) {
      text += fmt::format(
          "{}{}; {} m off, energy {}", row.trial.kind == Kind::kWithout ? ", saves " : ", spared ",
          savedText(results, row), numberText(row.trace.errors.error), energyText(row.trace));
    }
    const std::string outcome = outcomeText(row.trace);
    text += outcome.empty() ? "\n" : "\n      " + outcome + "\n";
  }
  return text;
}

std::string effectsRow(const EffectResults& results) {
  const EffectRow* everything = results.find(Kind::kEverythingOn);
  const bool known = everything != nullptr && everything->trace.repeats > 0;
  return fmt::format("| `{}` | {} | {:.2g} | {} |\n", results.name, listText(results.effects),
                     1e3 * results.rows.front().trace.processor / results.fps,
                     known ? fmt::format("{:.0f} %", 100 * results.saved(*everything)) : "–");
}

ReportSection effectsSection(const EffectResults& results) {
  ReportSection section{
      results.name,
      results.title,
      {ReportText{results.name + ": " + listText(results.effects) + ".", Look::kQuiet},
       chartOf(results), tableOf(results)}};
  addList(
      results, "Not taken out: ",
      [](const scenes::Effect& e) {
        const bool stays = e.on && !e.stays.empty() && e.part != scenes::EffectPart::kPictures;
        return stays ? e.name + ": " + e.stays : "";
      },
      section);
  addList(
      results, "Left out by the program: ",
      [](const scenes::Effect& e) {
        return e.leftOut ? fmt::format("{} ({})", e.name, e.why) : "";
      },
      section);
  return section;
}

}  // namespace app
