// What all diagrams of a study share: ranges, the lines of 1 %, 0.1 %, 0.01 %, the strip of
// failures, and gnuplot's words for them.
#pragma once

#include <functional>
#include <string>

#include "app/study/study_plan.h"

namespace app {

struct PlotFrame {
  double lowX = 0, highX = 1, lowY = 0, highY = 1;  // of what is ok
  double topY = 1;                                  // the strip of failures ends here
  bool hasStrip = false;

  double shown(double error) const;               // an error of zero is drawn at the bottom
  double stripLine(int method, int count) const;  // where a method's failures are drawn
};

// Holds every point; with `realTime`, 1 s per s as well.
PlotFrame makeFrame(const StudyResults& results, double (*x)(const StudyPoint&), bool realTime);

std::string beginPlot(const StudyResults& results, const PlotFrame& frame, const std::string& x);
std::string realTimeLine(const PlotFrame& frame);
// Draws `plot` into NAME.svg, of that size in pixels, and NAME.png, twice as large.
std::string endPlot(const std::string& name, const std::string& plot, int width = 960,
                    int height = 440);

std::string superscript(std::string text);  // "m^2" -> "m²"

// Letters that gnuplot would take for marks are made plain.
std::string plotText(const std::string& text);

}  // namespace app
