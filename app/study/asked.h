// Accuracy asked for against accuracy delivered, over all cases of a study.
#pragma once

#include <string>
#include <vector>

#include "app/study/chart.h"
#include "app/study/results.h"

namespace app {

constexpr double kDelivered = 3;  // times what was asked for still counts as delivered
constexpr double kDear = 1.5;     // times what a setting chosen by hand costs

struct AskedPoint {
  enum class Verdict { kDelivered, kBeyond, kUnjudged };
  std::string study;
  const Trace* point = nullptr;
  double asked = 0;
  double delivered = 0;  // its error over the case's scale; infinite: it failed
  double reference = 0;  // the reference's own error over the scale, where it is known
  // Its cost over that of the cheapest setting of ours chosen by hand that delivers what was asked
  // for, or what it delivered where that is less accurate; 0: nothing else delivers it, or the case
  // does not measure the motion.
  double overByHand = 0;
  Verdict verdict = Verdict::kDelivered;
};

// The points that were asked for an accuracy, case by case. A mean square counts with its root.
// A reference that is off by more than what was asked judges nothing.
std::vector<AskedPoint> askedPoints(const std::vector<const CaseResults*>& cases);

// asked.csv: a line of heads, then one for each point.
std::string askedTable(const std::vector<AskedPoint>& points);

// Delivered over asked.
Chart askedChart(const std::vector<AskedPoint>& points);

// "210 of 234 points (90 %) are within 3 times ...", and what they cost beside settings chosen by
// hand, the dearer ones by name; empty: there is none.
std::string askedText(const std::vector<AskedPoint>& points);

}  // namespace app
