// Diagrams in gnuplot's words.
#include "app/study/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/gnuplot.h"
#include "app/base/numbers.h"
#include "scenes/read/file_text.h"

namespace app {

namespace {

namespace fs = std::filesystem;

// Letters that gnuplot would take for marks are made plain.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : superscript(text)) {
    if (std::string("_^{}@&~").find(c) != std::string::npos) result += "\\\\";
    result += c == '"' || c == '\\' ? '\'' : c;
  }
  return result;
}

std::string ticks(const std::vector<std::pair<double, std::string>>& all) {
  std::string text;
  for (const auto& [value, word] : all) {
    std::string words;  // gnuplot takes them for a format
    for (const char c : plain(word)) words += c == '%' ? "%%" : std::string(1, c);
    text += fmt::format("{}\"{}\" {:.9g}", text.empty() ? "" : ", ", words, value);
  }
  return "(" + text + ")";
}

std::string axisText(const char* name, const ChartAxis& axis) {
  std::string text =
      fmt::format("set {0}range [{1:.9g}:{2:.9g}]\n", name, axis.reversed ? axis.high : axis.low,
                  axis.reversed ? axis.low : axis.high);
  if (!axis.title.empty()) {
    text += fmt::format("set {}label \"{}\"{}\n", name, plain(axis.title),
                        *name == 'y' ? " offset 1,0" : "");
  }
  if (axis.log) text += fmt::format("set logscale {0}\nset format {0} \"10^{{%T}}\"\n", name);
  if (!axis.shown) return text + fmt::format("unset {}tics\n", name);
  text += fmt::format("set {}tics {} nomirror out scale 0.7,0.35\n", name,
                      axis.ticks.empty() ? "" : ticks(axis.ticks));
  return text + fmt::format("set grid {}tics lc rgb '#ececec' lw 1 lt 1\n", name);
}

// Ticks on the right, with a line each.
std::string secondText(const ChartAxis& y) {
  if (y.second.empty()) return "";
  std::string text = fmt::format("{}set y2range [{:.9g}:{:.9g}]\n",
                                 y.log ? "set logscale y2\n" : "", y.low, y.high);
  for (const auto& [value, word] : y.second) {
    text += fmt::format(
        "set arrow from graph 0,first {0:.9g} to graph 1,first {0:.9g} nohead back lw 1 dt (6,4) "
        "lc rgb '#b0b0b0'\n",
        value);
  }
  return text +
         fmt::format("set y2tics {} scale 0 textcolor rgb '#707070' font ',10'\n", ticks(y.second));
}

std::string dashText(const std::string& dash) { return dash.empty() ? "" : " dt " + dash; }

std::string around(const Chart& chart) {
  std::string text;
  for (const ChartBox& b : chart.boxes) {
    text += fmt::format(
        "set object rectangle from {:.9g},{:.9g} to {:.9g},{:.9g} {}fs solid 1 noborder fc rgb "
        "'{}'\n",
        b.from.x, b.from.y, b.to.x, b.to.y, b.behind ? "behind " : "", b.color);
  }
  for (const ChartLine& l : chart.lines) {
    text += fmt::format(
        "set arrow from {:.9g},{:.9g} to {:.9g},{:.9g} {}{} lw {:g}{} lc rgb '{}'\n", l.from.x,
        l.from.y, l.to.x, l.to.y, l.arrow ? "head filled size screen 0.006,25" : "nohead",
        l.behind ? " back" : " front", l.width, dashText(l.dash), l.color);
  }
  for (const ChartLabel& l : chart.labels) {
    const std::string words = plain(l.text);
    text +=
        fmt::format("set label \"{}\" at {:.9g},{:.9g} {}{} front font ',{}' textcolor rgb '{}'\n",
                    l.bold ? "{/:Bold " + words + "}" : words, l.at.x, l.at.y,
                    l.side == 'l'   ? "left"
                    : l.side == 'r' ? "right"
                                    : "center",
                    l.upward ? " rotate by 90 offset -0.8,0" : "", l.size, l.color);
  }
  return text;
}

std::string styleOf(const ChartSeries& s) {
  constexpr int kTypes[] = {7, 5, 9, 11, 13, 15, 6, 4, 8, 10, 12, 14, 1, 2, 3};
  std::string style = s.line && s.marker >= 0 ? "linespoints" : s.line ? "lines" : "points";
  if (s.marker >= 0) {
    const auto type = static_cast<std::size_t>(s.marker) % std::size(kTypes);
    style += fmt::format(" pt {} ps {:g}", kTypes[type], s.size);
  }
  return fmt::format("{} lw {:g}{} lc rgb '{}' {}", style, s.width, dashText(s.dash), s.color,
                     s.title.empty() ? "notitle" : "title \"" + plain(s.title) + "\"");
}

}  // namespace

std::string chartScript(const Chart& chart) {
  std::string text = fmt::format("# {}. Drawn by: gnuplot THIS_FILE\n", chart.name);
  if (!chart.title.empty()) {
    text += fmt::format("set title \"{}\" font ',13' offset 0,-0.4\n", plain(chart.title));
  }
  text += chart.bare ? "unset border\nunset key\nset tmargin at screen 1\nset bmargin at screen 0\n"
                     : fmt::format(
                           "set border 3 lw 1 lc rgb '#404040'\n"
                           "set key at screen {:.4g},screen 0.90 left top Left reverse "
                           "spacing 1.25 samplen 2 maxcols 1 font ',10'\n",
                           chart.right + (chart.y.second.empty() ? 0.025 : 0.065));
  text += fmt::format("set lmargin at screen {:g}\nset rmargin at screen {:g}\n", chart.left,
                      chart.right);
  text += axisText("x", chart.x) + axisText("y", chart.y) + secondText(chart.y) + around(chart);
  std::string plot;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const ChartSeries& series = chart.series[i];
    if (series.points.empty()) continue;
    text += fmt::format("$d{} << EOD\n", i);
    for (const ChartPoint& p : series.points) text += fmt::format("{:.9g} {:.9g}\n", p.x, p.y);
    text += "EOD\n";
    plot += fmt::format("{}$d{} with {}", plot.empty() ? "plot " : ", \\\n  ", i, styleOf(series));
  }
  if (plot.empty()) plot = "plot NaN notitle";
  return text + fmt::format(
                    "set terminal svg size {2},{3} font 'DejaVu Sans,11' background rgb 'white'\n"
                    "set output '{0}.svg'\n{1}\nunset output\n"
                    "set terminal pngcairo size {4},{5} fontscale 2 linewidth 2 pointscale 2 font "
                    "'DejaVu Sans,11' background rgb 'white'\n"
                    "set output '{0}.png'\nreplot\nunset output\n",
                    chart.name, plot, chart.width, chart.height, 2 * chart.width, 2 * chart.height);
}

void drawChart(const Chart& chart, const fs::path& folder) {
  const std::string script = chartScript(chart);
  const auto known = scenes::fileText(folder / (chart.name + ".gp"));
  const bool isDrawn = fs::exists(folder / (chart.name + ".svg")) &&
                       fs::exists(folder / (chart.name + ".png")) && known == script;
  if (!isDrawn) runGnuplot(script, folder, chart.name);
}

ChartAxis logAxis(const std::string& title, const std::vector<double>& values) {
  constexpr double kLeast = 1e-17;
  double low = INFINITY, high = 0;
  for (const double value : values) {
    if (!(value > 0) || !std::isfinite(value)) continue;
    low = std::min(low, std::max(value, kLeast));
    high = std::max(high, std::max(value, kLeast));
  }
  if (high == 0) low = high = 1;
  ChartAxis axis{title,
                 std::pow(10.0, std::floor(std::log10(low) + 1e-9)),
                 std::pow(10.0, std::ceil(std::log10(high) - 1e-9)),
                 true,
                 false,
                 true,
                 {},
                 {}};
  if (axis.high < 5 * axis.low) axis.high = 10 * axis.low;
  return axis;
}

}  // namespace app
