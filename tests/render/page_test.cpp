// Pages: tiles keep their bytes, plots and text are drawn beside them, and marks are understood.
#include "render/page.h"

#include <gtest/gtest.h>

#include "render/chart_legend.h"
#include "render/marked_text.h"

namespace render {
namespace {

Image filledImage(int width, int height, std::uint8_t value) {
  return {width, height,
          std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), value)};
}

std::uint8_t redAt(const Image& image, int x, int y) {
  return image.rgb[static_cast<std::size_t>(3 * (y * image.width + x))];
}

int darkPixels(const Image& image, int left, int top, int right, int bottom) {
  int count = 0;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) count += redAt(image, x, y) < 128;
  }
  return count;
}

Page pageWithTile() {
  Page page;
  page.width = 200;
  page.height = 120;
  page.tiles.push_back({10, 20, filledImage(50, 40, 77)});
  return page;
}

TEST(Page, TilesKeepTheirBytesBelowText) {
  Page page = pageWithTile();
  page.texts.push_back({{100, 100}, "words", 20, 0, {0, 0, 0, 1}, false});
  const Image image = PagePrinter().print(page);
  for (int y = 20; y < 60; ++y) {
    for (int x = 10; x < 60; ++x) ASSERT_EQ(redAt(image, x, y), 77);
  }
  EXPECT_EQ(redAt(image, 9, 20), 255);
  EXPECT_EQ(redAt(image, 60, 59), 255);
}

TEST(Page, TextStandsWhereItIsAnchored) {
  for (const float anchor : {0.0f, 0.5f, 1.0f}) {
    Page page = pageWithTile();
    page.texts.push_back({{130, 100}, "lll", 20, anchor, {0, 0, 0, 1}, false});
    const Image image = PagePrinter().print(page);
    EXPECT_EQ(darkPixels(image, 60, 80, 130, 105) > 0, anchor > 0) << anchor;
    EXPECT_EQ(darkPixels(image, 130, 80, 200, 105) > 0, anchor < 1) << anchor;
  }
}

TEST(Page, WhatReachesOverItIsCut) {
  Page page = pageWithTile();
  page.tiles.push_back({180, 100, filledImage(50, 50, 1)});
  page.tiles.push_back({-30, -30, filledImage(40, 40, 2)});
  const Image image = PagePrinter().print(page);
  EXPECT_EQ(redAt(image, 199, 119), 1);
  EXPECT_EQ(redAt(image, 0, 0), 2);
}

TEST(Page, TheSameBytesEveryTime) {
  Page page = pageWithTile();
  Chart chart{{"x", false, {}, {}}, {"y", true, {}, {}}, {{"a", {{0, 1}, {1, 10}}, {1, 0, 0, 1}}}};
  page.plots.push_back({{60, 0}, {200, 120}, chart, 10});
  PagePrinter printer;
  const Image first = printer.print(page);
  EXPECT_EQ(first, printer.print(page));
  EXPECT_EQ(first, PagePrinter().print(page));
  EXPECT_GT(darkPixels(first, 60, 0, 200, 120), 100);
}

TEST(Page, ChartsTakeWhatIsNotFiniteAndNoData) {
  for (const std::vector<Eigen::Vector2d>& points :
       {std::vector<Eigen::Vector2d>{}, {{0, NAN}, {1, INFINITY}}, {{0, -1}, {1, 0}}, {{3, 3}}}) {
    Page page = pageWithTile();
    Chart chart{{"x", false, {}, {}}, {"y", true, {}, {}}, {{"a", points, {1, 0, 0, 1}}}};
    page.plots.push_back({{60, 0}, {200, 120}, chart, 10});
    EXPECT_NO_THROW(PagePrinter().print(page));
  }
}

// Left edges of the frames of all plots, the outlines [px].
std::vector<float> leftEdges(const Page& page) {
  std::vector<float> edges;
  for (const Ink& ink : PagePrinter().inkOf(page)) {
    if (ink.kind != Ink::Kind::kCurve || !ink.closed) continue;
    edges.push_back(ink.points[0].x());
    for (const Eigen::Vector2f& p : ink.points) edges.back() = std::min(edges.back(), p.x());
  }
  return edges;
}

TEST(Page, FramesOfPlotsUnderEachOtherBeginUnderEachOther) {
  Page page = pageWithTile();
  const auto chartTo = [](double high) {
    return Chart{{"x", false, {}, {}}, {"y", false, {}, {}}, {{"", {{0, 0}, {1, high}}}}};
  };
  page.plots.push_back({{0, 0}, {200, 60}, chartTo(1), 10});
  const std::vector<float> alone = leftEdges(page);
  page.plots.push_back({{0, 60}, {200, 120}, chartTo(20000), 10});
  const std::vector<float> both = leftEdges(page);
  ASSERT_EQ(alone.size(), 1u);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0], both[1]);
  EXPECT_GT(both[0], alone[0] + 5);
  page.plots[1].from.x() = 20;  // not under it
  EXPECT_EQ(leftEdges(page)[0], alone[0]);
}

TEST(Page, RefusesToHaveNoArea) {
  EXPECT_THROW(PagePrinter().print(Page{}), std::invalid_argument);
}

TEST(MarkedText, LowersRaisesAndSlants) {
  using Runs = std::vector<TextRun>;
  EXPECT_EQ(textRuns("*p*_{i} m^{2}"),
            (Runs{{"p", 0, true}, {"i", -1, false}, {" m", 0, false}, {"2", 1, false}}));
  EXPECT_EQ(textRuns("body_1 2*3 \\*"), (Runs{{"body_1 2*3 *", 0, false}}));
  EXPECT_EQ(letterCount("δ*p*_{ij}"), 4);
}

TEST(Legend, SegmentsMeetARectangleOrNot) {
  const Pixel low(10, 10), high(20, 20);
  EXPECT_TRUE(crosses({0, 0}, {30, 30}, low, high));
  EXPECT_TRUE(crosses({12, 12}, {13, 13}, low, high));
  EXPECT_TRUE(crosses({15, 0}, {15, 40}, low, high));
  EXPECT_FALSE(crosses({0, 0}, {30, 5}, low, high));
  EXPECT_FALSE(crosses({21, 0}, {21, 40}, low, high));
}

TEST(Legend, CurvesAreCutAtTheFrame) {
  const auto parts =
      clipToFrame({{0, 15}, {40, 15}, {40, 50}, {15, 50}, {15, 0}}, {10, 10}, {20, 20});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_LT((parts[0].front() - Pixel(10, 15)).norm(), 1e-4f);
  EXPECT_LT((parts[0].back() - Pixel(20, 15)).norm(), 1e-4f);
  EXPECT_LT((parts[1].front() - Pixel(15, 20)).norm(), 1e-4f);
  EXPECT_LT((parts[1].back() - Pixel(15, 10)).norm(), 1e-4f);
}

}  // namespace
}  // namespace render
