// Discs and the sky by the golden angle, pixels by the additive recurrence of the plastic number.
#include "render/exposure.h"

#include <cmath>

namespace render {
namespace {

// Points k = 0, 1, ... turned on by the golden angle each; no libm, whose last bit depends on the
// CPU.
class GoldenTurns {
 public:
  Eigen::Vector2d next() {
    const Eigen::Vector2d now = at_;
    at_ = {kCos * now.x() - kSin * now.y(), kSin * now.x() + kCos * now.y()};
    return now;
  }

 private:
  static constexpr double kCos = -0.7373688780783197, kSin = 0.6754902942615238;
  Eigen::Vector2d at_{1, 0};
};

double fraction(double x) { return x - std::floor(x); }

}  // namespace

std::vector<Exposure> spreadExposures(int count) {
  constexpr double kPlastic = 1.324717957244746;  // x^3 = x + 1
  std::vector<Exposure> all(static_cast<std::size_t>(count));
  GoldenTurns onDisc, onSky;
  for (int i = 0; i < count; ++i) {
    Exposure& one = all[static_cast<std::size_t>(i)];
    one.aside = {static_cast<float>(fraction(0.5 + i / kPlastic) - 0.5),
                 static_cast<float>(fraction(0.5 + i / (kPlastic * kPlastic)) - 0.5)};
    one.onLight = (std::sqrt((i + 0.5) / count) * onDisc.next()).cast<float>();
  }
  // Equal areas of the half sphere lie between equal heights.
  for (int k = 0; k < kSkies; ++k) {
    for (Exposure& one : all) {
      const auto i = static_cast<double>(&one - all.data());
      const double height = (k * count + i + 0.5) / (kSkies * count);
      const Eigen::Vector2d around = std::sqrt(1 - height * height) * onSky.next();
      one.sky[static_cast<std::size_t>(k)] = {static_cast<float>(around.x()),
                                              static_cast<float>(height),
                                              static_cast<float>(around.y())};
    }
  }
  return all;
}

}  // namespace render
