// Ticks stand at round numbers within the axis' ends.
#include "render/axis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace render {
namespace {

std::vector<std::string> textsOf(const std::vector<Tick>& ticks) {
  std::vector<std::string> texts;
  for (const Tick& tick : ticks) {
    if (!tick.text.empty()) texts.push_back(tick.text);
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(Axis, TicksStandAtStepsOfOneTwoAndFive) {
  EXPECT_EQ(textsOf(ticksOf({0, 1, false}, 6)), (Texts{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(textsOf(ticksOf({0, 2, false}, 5)), (Texts{"0", "0.5", "1.0", "1.5", "2.0"}));
  EXPECT_EQ(textsOf(ticksOf({-30, 30, false}, 3)), (Texts{"−20", "0", "20"}));
}

TEST(Axis, TicksOfFarNumbersCarryTheirPowerOfTen) {
  EXPECT_EQ(textsOf(ticksOf({0, 4e6, false}, 4)), (Texts{"0", "1·10⁶", "2·10⁶", "3·10⁶", "4·10⁶"}));
}

TEST(Axis, EndsAreWidenedToTicks) {
  const Scale scale = scaleOver(0.13, 3.7, false, 5);
  EXPECT_DOUBLE_EQ(scale.low, 0);
  EXPECT_DOUBLE_EQ(scale.high, 4);
}

TEST(Axis, EndsThatAreTicksStay) {
  const Scale scale = scaleOver(-1.2, 1.2, false, 6);
  EXPECT_NEAR(scale.low, -1.5, 1e-12);
  EXPECT_NEAR(scaleOver(0, 0.3, false, 3).high, 0.3, 1e-12);
}

TEST(Axis, LogarithmicEndsArePowersOfTen) {
  const Scale scale = scaleOver(3e-7, 2, true, 6);
  EXPECT_NEAR(scale.low, 1e-7, 1e-16);
  EXPECT_NEAR(scale.high, 10, 1e-9);
  EXPECT_NEAR(scale.shareOf(1e-3), 0.5, 1e-12);
}

TEST(Axis, ManyDecadesAreLabelledNowAndThen) {
  const Texts texts = textsOf(ticksOf({1e-15, 10, true}, 6));
  EXPECT_EQ(texts.front(), "10⁻¹⁴");
  EXPECT_EQ(texts.back(), "10¹");
  EXPECT_EQ(texts.size(), 6u);
}

TEST(Axis, SaysThatItsLowEndHoldsWhatIsLess) {
  EXPECT_EQ(textsOf(ticksOf({1e-12, 0.1, true, true}, 6)),
            (Texts{"≤ 10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²"}));
  EXPECT_EQ(textsOf(ticksOf({1e-12, 0.1, true}, 6)),
            (Texts{"10⁻¹¹", "10⁻⁹", "10⁻⁷", "10⁻⁵", "10⁻³", "10⁻¹"}));
}

TEST(Axis, FewDecadesHaveMinorTicks) { EXPECT_EQ(ticksOf({1, 100, true}, 6).size(), 3u + 2 * 8); }

TEST(Axis, WithoutDataThereIsStillAnAxis) {
  for (const bool logarithmic : {false, true}) {
    const Scale scale = scaleOver(INFINITY, -INFINITY, logarithmic, 6);
    EXPECT_LT(scale.low, scale.high);
    EXPECT_GE(ticksOf(scale, 6).size(), 2u);
  }
}

TEST(Axis, OneValueHasRoomAroundIt) {
  for (const double value : {0.0, 5.0, -1e-12, 1e9}) {
    const Scale scale = scaleOver(value, value, false, 6);
    EXPECT_LT(scale.low, value);
    EXPECT_GT(scale.high, value);
  }
}

}  // namespace
}  // namespace render
