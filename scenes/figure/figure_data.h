// What a figure's runs measured, as verdicts on its claims and as charts.
#pragma once

#include "scenes/figure/figure_sheet.h"

namespace scenes {

struct FigureVerdict {
  std::string text;      // the claim's words
  std::string measured;  // "largest |axle_error - law| 3.1e-07 rad"
  std::string bound;     // "<= 1e-06 rad"
  double value = 0;
  bool holds = false;
};

// `series`: one per run of the sheet, of every frame.
FigureVerdict judge(const FigureMeasure& measure, const FigureSheet& sheet,
                    const std::vector<Series>& series);

render::Chart chartOf(const FigurePlot& plot, const std::vector<Series>& series);

// y at x along straight lines between the points; the end values beyond them. Their x increases.
double valueOnLine(const std::vector<Eigen::Vector2d>& points, double x);

}  // namespace scenes
