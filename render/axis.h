// Ticks of a plot's axis: round numbers for linear axes, powers of ten for logarithmic ones.
#pragma once

#include <string>
#include <vector>

namespace render {

struct Tick {
  double value = 0;
  std::string text;  // empty: a minor tick
};

struct Scale {  // an axis that has its ends
  double low = 0, high = 1;
  bool logarithmic = false;
  bool holdsLess = false;  // logarithmic: at its low end stands what is less, too

  // 0 at the low end, 1 at the high end, unclamped; `value` > 0 where logarithmic.
  double shareOf(double value) const;
};

// The ends of an axis over values from `low` to `high`, widened to ticks that are at most `most`
// intervals apart. An empty range (low > high) gives 0..1 or 1..10, a single value room around it.
Scale scaleOver(double low, double high, bool logarithmic, int most);

// Ascending, within the ends; at most about `most` of them have a text.
std::vector<Tick> ticksOf(const Scale& scale, int most);

// "10⁻³", for whole exponents.
std::string powerOfTen(int exponent);

}  // namespace render
