// A figure as data: which scenes it simulates, what it shows of them, and what it measures. Read
// from TOML as scenes are, with the same errors.
#pragma once

#include "render/chart.h"
#include "scenes/measure/series.h"
#include "scenes/scene.h"

namespace scenes {

struct FigureRun {
  std::string name;
  Scene scene;
};

struct FigureNote {  // [[panel.note]]: text at a place of the world or beside a body
  std::string text;
  physics::Vec3 at = physics::Vec3::Zero();
  std::string body;                      // empty: `at` is in the world, else from its centre
  std::array<double, 2> offset{0.5, 0};  // in lines of text, right and up
};

struct FigurePanel {  // [[panel]]: pictures of one run
  enum class Stamp { kAuto, kNone, kTime, kIteration };
  std::string name, label;
  int run = 0;
  std::optional<int> ghost;  // a run that is seen through, in the same frames
  std::vector<int> frames;   // ascending in time; one tile each, or superimposed (onion skin)
  std::optional<CameraDef> camera, filmCamera;  // of stills and of the film, else the scene's
  Overlays overlays;
  double opacity = 1;
  bool ground = true;
  Stamp stamp = Stamp::kAuto;    // automatic: the time where there is more than one tile
  int span = 1;                  // columns
  std::optional<double> aspect;  // of its cells; the highest of a row decides. Absent: the sheet's
  std::vector<FigureNote> notes;
};
std::span<const char* const> names(FigurePanel::Stamp);

struct FigureCurve {  // [[plot.curve]]: a metric of a run against another, or against its clock
  int run = 0;
  MetricOf x{"time", ""}, y;
  double scaleX = 1, scaleY = 1;
  std::string name;
  std::optional<render::Color> color;
  bool dashed = false, marks = false, line = true;
  int every = 1;                   // of the frames
  std::optional<double> from, to;  // s; absent: the whole run
};

struct FigureLine {  // [[plot.line]]: a law, or a bound, through points
  std::string name;
  std::vector<Eigen::Vector2d> points;
};

struct FigurePlot {  // [[plot]]
  std::string name, label;
  render::ChartAxis x, y;
  std::vector<FigureCurve> curves;
  std::vector<FigureLine> lines;
  int span = 1;
  std::optional<double> aspect;
};

struct FigureMeasure {  // [[measure]]: a number that the figure claims
  enum class Over { kLast, kMax, kMin, kMean };
  struct Quantity {
    int run = 0;
    MetricOf what;
    Over over = Over::kLast;
    std::optional<int> frame;        // instead of `over`
    std::optional<double> from, to;  // s; absent: the whole run
  };
  std::string text;
  Quantity of;
  std::optional<Quantity> relativeTo;  // the value is `of` divided by it
  bool toFrameBefore = false;          // each frame\'s value is divided by the one before
  std::vector<Eigen::Vector2d> law;    // instead of y itself |y - law(x)|
  MetricOf lawAlong;                   // x of the law
  std::optional<double> atMost, atLeast;
};
std::span<const char* const> names(FigureMeasure::Over);

struct FigureTile {  // what stands in one cell
  bool isPlot = false;
  int index = 0;            // of the panel or the plot
  std::vector<int> frames;  // of a panel: one, or all for an onion skin
  int span = 1;
  std::optional<double> aspect;
  bool first = true;  // of its panel
};

struct FigureSheet {
  enum class Layout { kStrip, kGrid, kSideBySide, kOnionSkin };
  std::string path, text;
  std::string name;  // figure01, or the file's own name where it has no number
  int number = 0;    // 0: none
  std::string title, claim;
  Layout layout = Layout::kGrid;
  int columns = 0;       // 0: as the layout wants
  int width = 2050;      // px; 174 mm at 300 dpi
  double aspect = 1.33;  // width over height of a cell
  bool video = false;
  std::vector<FigureRun> runs;
  std::vector<FigurePanel> panels;
  std::vector<FigurePlot> plots;
  std::vector<FigureTile> tiles;  // panels and plots in the order of the file
  std::vector<FigureMeasure> measures;

  int columnCount() const;
};
std::span<const char* const> names(FigureSheet::Layout);

// `figure` is a number or a name of the shipped sheets, or a path. Throws InputError.
FigureSheet readFigureSheet(const std::string& figure);
FigureSheet parseFigureSheet(const std::string& text, const std::string& path);

std::vector<std::string> figureSheets();  // paths of the shipped ones, by number

// Every metric that plots and measures want of a run.
std::vector<MetricOf> metricsOf(const FigureSheet& sheet, int run);

}  // namespace scenes
