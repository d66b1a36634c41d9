// Axes of the running plots, and the overlay's places in the picture.
#include "render/hud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/renderer.h"
#include "sample.h"

namespace render {
namespace {

Plot plotOf(std::vector<float> values, bool logarithmic) {
  return {"title", "m", {{"curve", std::move(values), {0, 0, 0, 1}}}, 0, logarithmic};
}

TEST(Axis, IncludesZeroAndEndsAtARoundNumber) {
  const AxisRange range = axisRangeOf(plotOf({3, 17.2f}, false));
  EXPECT_FLOAT_EQ(range.low, 0);
  EXPECT_FLOAT_EQ(range.high, 20);
  EXPECT_EQ(range.highText, "20");
  EXPECT_FLOAT_EQ(axisRangeOf(plotOf({-0.3f, 0.1f}, false)).low, -0.5f);
}

TEST(Axis, SpansWholeDecadesWhenLogarithmic) {
  const AxisRange range = axisRangeOf(plotOf({2e-7f, 0.3f}, true));
  EXPECT_FLOAT_EQ(range.low, -7);
  EXPECT_FLOAT_EQ(range.high, 0);
  EXPECT_EQ(range.lowText, "10⁻⁷");
  EXPECT_EQ(range.highText, "10⁰");
}

TEST(Axis, LeavesOutWhatCannotBeShown) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_FLOAT_EQ(axisRangeOf(plotOf({1, infinity, std::nanf("")}, false)).high, 1);
  EXPECT_FLOAT_EQ(axisRangeOf(plotOf({0, -1, 0.1f}, true)).low, -1);
  EXPECT_LT(axisRangeOf(plotOf({}, false)).low, axisRangeOf(plotOf({}, false)).high);
  EXPECT_LT(axisRangeOf(plotOf({0, 0}, true)).low, axisRangeOf(plotOf({0, 0}, true)).high);
}

class Overlay : public ::testing::Test {
 protected:
  // Pixels that differ from the empty picture in the given rectangle.
  int drawn(const Picture& picture, int x0, int y0, int x1, int y1) {
    Picture empty;
    empty.ground.visible = false;
    const Image before = renderer.draw(empty);
    const Image& after = renderer.draw(picture);
    int count = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        count += before.rgb[static_cast<std::size_t>(3 * (y * 640 + x))] !=
                 after.rgb[static_cast<std::size_t>(3 * (y * 640 + x))];
    return count;
  }
  static Picture flat() {
    Picture picture;
    picture.ground.visible = false;
    picture.camera = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40};
    return picture;
  }
  Renderer renderer{{640, 360, Quality::kDraft, ""}};
};

TEST_F(Overlay, WritesALabelBesideItsPointAndNotBehindTheCamera) {
  Picture picture = flat();
  picture.labels = {{{0, 0, 0}, "λ → 2", {8, -8}, {0, 0, 0, 1}, 18}};
  EXPECT_GT(drawn(picture, 320, 160, 380, 180), 40);
  EXPECT_EQ(drawn(picture, 0, 0, 310, 360), 0);
  picture.labels[0].at = {0, 0, 9};
  EXPECT_EQ(drawn(picture, 0, 0, 640, 360), 0);
}

TEST_F(Overlay, WritesTheCaptionAtTheLowerLeft) {
  Picture picture = flat();
  picture.caption = "Figure";
  EXPECT_GT(drawn(picture, 0, 330, 100, 360), 40);
  EXPECT_EQ(drawn(picture, 0, 0, 640, 330), 0);
}

// Names of curves wrap, a long title shrinks: what is left and right of the panel stays as it was.
TEST_F(Overlay, KeepsNamesAndTitleInThePanel) {
  Picture picture = flat();
  picture.hud = sampleHud(2);
  picture.hud.title = std::string(80, 'W');
  Plot& plot = picture.hud.plots.front();
  while (plot.curves.size() < 12) {
    plot.curves.push_back(plot.curves.front());
    plot.curves.back().name = "limit_of_a_cone";
  }
  EXPECT_GT(drawn(picture, 8, 0, 8 + 134, 360), 1000);
  EXPECT_EQ(drawn(picture, 0, 0, 7, 360), 0);
  EXPECT_EQ(drawn(picture, 8 + 134 + 2, 0, 640, 360), 0);
}

TEST_F(Overlay, KeepsAValueClearOfItsName) {
  Picture picture = flat();
  picture.hud.visible = true;
  picture.hud.rows = {{"step", ""}};
  const int name = drawn(picture, 14, 8, 14 + 17, 360);
  picture.hud.rows = {{"step", std::string(120, 'i')}};
  EXPECT_EQ(drawn(picture, 14, 8, 14 + 17, 360), name);
  EXPECT_GT(drawn(picture, 14 + 24, 8, 8 + 132, 360), 100);
}

TEST_F(Overlay, KeepsThePanelWhereItIsWhileThePlotsGrow) {
  Picture picture = flat();
  picture.hud = sampleHud(2);
  const int panel = drawn(picture, 0, 0, 8 + 134 + 2, 180);
  EXPECT_GT(panel, 1000);
  picture.hud = sampleHud(200);
  EXPECT_EQ(drawn(picture, 8 + 134 + 2, 0, 640, 360), 0);
  picture.hud.visible = false;
  EXPECT_EQ(drawn(picture, 0, 0, 640, 360), 0);
}

TEST_F(Overlay, DrawsValuesThatCannotBeShownAsGaps) {
  Picture picture = flat();
  picture.hud.visible = true;
  picture.hud.plots = {{"", "", {{"", std::vector<float>(100, 0.5f), {1, 0, 0, 1}}}, 0, false}};
  const Image whole = renderer.draw(picture);
  picture.hud.plots[0].curves[0].values[50] = std::nanf("");
  const Image& gap = renderer.draw(picture);
  int changed = 0;
  for (std::size_t i = 0; i < gap.rgb.size(); i += 3) changed += gap.rgb[i + 1] > whole.rgb[i + 1];
  EXPECT_GT(changed, 0);
  EXPECT_LT(changed, 20);
}

}  // namespace
}  // namespace render
