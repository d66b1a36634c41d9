// A diagram of a study: series over two axes, and the lines, boxes and words around them. Plain
// data in, a script for gnuplot out, which draws it as SVG and PNG.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace app {

struct ChartAxis {
  std::string title{};
  double low = 0, high = 1;
  bool log = false, reversed = false;
  bool shown = true;                                     // with ticks
  std::vector<std::pair<double, std::string>> ticks{};   // empty: gnuplot's own
  std::vector<std::pair<double, std::string>> second{};  // on the other side, with a line each
};

struct ChartPoint {
  double x = 0, y = 0;
};

struct ChartSeries {
  std::string title;  // empty: not in the legend
  std::vector<ChartPoint> points{};
  std::string color = "#000000";  // "#rrggbb", or "#aarrggbb"
  int marker = -1;                // place in StudyMethod::Marker; -1: none
  double size = 1;
  bool line = false;
  double width = 2;
  std::string dash{};  // of the line, "(8,4)"
};

struct ChartLine {
  ChartPoint from, to;
  std::string color = "#404040", dash = "";
  double width = 1;
  bool arrow = false, behind = false;
};
struct ChartBox {
  ChartPoint from, to;
  std::string color;
  bool behind = false;
};
struct ChartLabel {
  ChartPoint at;
  std::string text;
  char side = 'l';  // l, c, r: where `at` is
  int size = 10;
  std::string color = "#303030";
  bool bold = false, upward = false;
};

struct Chart {
  std::string name;  // of the files
  std::string title{}, alt{}, caption{};
  ChartAxis x{}, y{};
  std::vector<ChartSeries> series{};
  std::vector<ChartLine> lines{};
  std::vector<ChartBox> boxes{};
  std::vector<ChartLabel> labels{};
  double left = 0.085, right = 0.60;  // of the width: where the axes are
  bool bare = false;                  // neither frame nor margins
  int width = 960, height = 440;      // px of the SVG
};

std::string chartScript(const Chart& chart);

// Writes NAME.gp, and draws NAME.svg and NAME.png where they are not of this script already. Throws
// EnvironmentError with what gnuplot said.
void drawChart(const Chart& chart, const std::filesystem::path& folder);

// The ends of an axis over positive values, in whole decades, one at least.
ChartAxis logAxis(const std::string& title, const std::vector<double>& values);

}  // namespace app
