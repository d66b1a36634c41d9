// Verdicts follow from series, charts hold what was asked for, cells fill the page, and letters
// keep apart.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/figure/figure_data.h"
#include "scenes/figure/figure_layout.h"
#include "scenes/view/label_placer.h"
#include "scenes/view/view.h"

namespace scenes {
namespace {

// A sheet with one measure of max_speed, over series 1, 2, 4, 3 at one frame per second.
class Judged {
 public:
  FigureMeasure measure;
  Judged() {
    sheet_.runs.push_back({"r", {}});
    measure.of.what = {"max_speed", ""};
    measure.atMost = 3.5;
    series_.push_back({1, 2, {{"max_speed", ""}}, {{1, 2, 4, 3}}});
  }
  FigureVerdict verdict() const { return judge(measure, sheet_, series_); }
  Series& series() { return series_[0]; }

 private:
  FigureSheet sheet_;
  std::vector<Series> series_;
};

TEST(FigureMeasure, TakesTheLastTheLargestTheSmallestOrTheMean) {
  using Over = FigureMeasure::Over;
  Judged judged;
  for (const auto& [over, value] : {std::pair{Over::kLast, 3.0}, std::pair{Over::kMax, 4.0},
                                    std::pair{Over::kMin, 1.0}, std::pair{Over::kMean, 2.5}}) {
    judged.measure.of.over = over;
    EXPECT_DOUBLE_EQ(judged.verdict().value, value);
  }
}

TEST(FigureMeasure, HoldsWithinItsBoundsOnly) {
  Judged judged;
  EXPECT_TRUE(judged.verdict().holds);
  judged.measure.atLeast = 3.1;
  EXPECT_FALSE(judged.verdict().holds);
  judged.measure.atLeast.reset();
  judged.measure.of.over = FigureMeasure::Over::kMax;
  EXPECT_FALSE(judged.verdict().holds);
}

TEST(FigureMeasure, LooksAtOneFrameOrASpan) {
  Judged judged;
  judged.measure.of.frame = 1;
  EXPECT_DOUBLE_EQ(judged.verdict().value, 2);
  judged.measure.of.frame.reset();
  judged.measure.of.to = 1.0;
  judged.measure.of.over = FigureMeasure::Over::kMax;
  EXPECT_DOUBLE_EQ(judged.verdict().value, 2);
}

TEST(FigureMeasure, IsARatioWhereItIsRelative) {
  Judged judged;
  judged.measure.relativeTo = judged.measure.of;
  judged.measure.relativeTo->frame = 1;
  EXPECT_DOUBLE_EQ(judged.verdict().value, 1.5);
}

TEST(FigureMeasure, IsTheLargestRatioToTheFrameBefore) {
  Judged judged;
  judged.measure.toFrameBefore = true;
  judged.measure.of.over = FigureMeasure::Over::kMax;
  EXPECT_DOUBLE_EQ(judged.verdict().value, 2);
  judged.series().values[0] = {0, 0, 0};
  EXPECT_DOUBLE_EQ(judged.verdict().value, 0);
}

TEST(FigureMeasure, IsTheDistanceFromALaw) {
  Judged judged;
  judged.measure.law = {{0, 1}, {3, 4}};  // 1, 2, 3, 4 at the frames
  judged.measure.lawAlong = {"time", ""};
  judged.measure.of.over = FigureMeasure::Over::kMax;
  EXPECT_DOUBLE_EQ(judged.verdict().value, 1);
}

TEST(FigureMeasure, NeverHoldsWithoutANumber) {
  Judged judged;
  judged.series().values[0][2] = std::nan("");
  judged.measure.of.over = FigureMeasure::Over::kMin;
  EXPECT_FALSE(judged.verdict().holds);
  Judged empty;
  empty.measure.of.from = 100.0;
  EXPECT_FALSE(empty.verdict().holds);
}

TEST(FigurePlot, CurvesRunAlongTheClockOrAMetric) {
  const std::vector<Series> series = {
      {2, 3, {{"max_speed", ""}, {"overlap", ""}}, {{1, 2, 4}, {7, 8, 9}}}};
  FigurePlot plot;
  FigureCurve curve;
  curve.y = {"max_speed", ""};
  for (const auto& [x, last] : {std::pair{"time", 1.0}, std::pair{"frame", 2.0},
                                std::pair{"iteration", 6.0}, std::pair{"overlap", 9.0}}) {
    curve.x = {x, ""};
    plot.curves = {curve};
    EXPECT_EQ(chartOf(plot, series).curves[0].points.back(), Eigen::Vector2d(last, 4)) << x;
  }
}

TEST(FigurePlot, AnErrorOfZeroIsSeenAtTheLowEndOfALogarithmicAxis) {
  FigurePlot plot;
  plot.y.logarithmic = true;
  plot.y.low = 1e-12;
  plot.curves.resize(1);
  plot.curves[0].y = {"max_speed", ""};
  const render::Chart chart = chartOf(plot, {{1, 1, {{"max_speed", ""}}, {{1, 0}}}});
  EXPECT_EQ(chart.curves[0].points[1].y(), 1e-12);
  EXPECT_TRUE(chart.y.holdsLess);
  EXPECT_FALSE(chartOf(plot, {{1, 1, {{"max_speed", ""}}, {{1, 2}}}}).y.holdsLess);
}

FigureSheet sheetWithCells(std::vector<int> spans, int columns) {
  FigureSheet sheet;
  sheet.columns = columns;
  sheet.aspect = 2;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    sheet.panels.push_back({});
    sheet.tiles.push_back({false, static_cast<int>(i), {0}, spans[i], {}, true});
  }
  return sheet;
}

TEST(FigureLayout, CellsFillTheWidthAndDoNotMeet) {
  const FigureSheet sheet = sheetWithCells({1, 1, 1, 2, 1}, 3);
  const FigureLayout layout = layOut(sheet, sheet.tiles, 3, 2050);
  const auto& cells = layout.cells;
  ASSERT_EQ(cells.size(), 5u);
  EXPECT_NEAR(cells[2].x + cells[2].width, 2050, 3);  // what does not divide by three
  EXPECT_EQ(cells[3].x, 0);
  EXPECT_EQ(cells[3].width, cells[1].x + cells[1].width);
  EXPECT_EQ(cells[4].x, cells[2].x);
  EXPECT_GT(cells[1].x, cells[0].x + cells[0].width);
  EXPECT_GT(cells[3].y, cells[0].y + cells[0].height);
  EXPECT_GE(layout.height, cells[4].y + cells[4].height);
  EXPECT_NEAR(static_cast<double>(cells[0].width) / cells[0].height, 2, 0.01);
}

TEST(FigureLayout, LabelsStandBelowTheirCellsAndShrinkWithThePage) {
  FigureSheet sheet = sheetWithCells({1, 1}, 2);
  sheet.panels[0].label = "pairwise";
  const FigureLayout layout = layOut(sheet, sheet.tiles, 2, 2050);
  ASSERT_EQ(layout.labels.size(), 2u);
  EXPECT_EQ(layout.labels[0].words, "(a) pairwise");
  EXPECT_EQ(layout.labels[1].words, "(b)");
  EXPECT_GT(layout.labels[0].at.y(), static_cast<float>(layout.cells[0].height));
  EXPECT_LT(layout.labels[0].at.y(), static_cast<float>(layout.height));
  EXPECT_FLOAT_EQ(layOut(sheet, sheet.tiles, 2, 1025).textSize, layout.textSize / 2);
}

TEST(FigureLayout, LongLabelsAreCutBetweenWords) {
  EXPECT_EQ(wrap("one two three", 10, 45), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(wrap("incompressible", 10, 20), (std::vector<std::string>{"incompressible"}));
}

TEST(Vectors, LettersOfAJointAreAllThereAndApart) {
  const FigureSheet sheet = readFigureSheet("2");
  Simulation simulation(sheet.runs[static_cast<std::size_t>(sheet.panels[0].run)].scene);
  ViewOptions options;
  options.overlays.vectors = true;
  options.aspect = 1;
  const render::Picture picture = view(simulation, {}, options, {});
  std::vector<std::string> words;
  for (const render::Label& label : picture.labels) words.push_back(label.text);
  EXPECT_EQ(words, (std::vector<std::string>{"*x*_{i}", "*r*_{i}", "*x*_{j}", "*r*_{j}", "*p*_{i}",
                                             "*p*_{j}", "δ*p*"}));
  const LabelPlacer placer(picture.camera, options.aspect);
  for (std::size_t i = 0; i < picture.labels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto &a = picture.labels[i], &b = picture.labels[j];
      const auto apart = (placer.project(a.at) + a.offset - placer.project(b.at) - b.offset).norm();
      EXPECT_GT(apart, 0.7f * a.size) << a.text << " " << b.text;
    }
  }
}

}  // namespace
}  // namespace scenes
