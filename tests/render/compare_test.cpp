// The gate lets through what another CPU does, and nothing else.
#include "render/compare.h"

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "sample.h"

namespace render {
namespace {

Renderer& goldenRenderer() {
  static Renderer shared({480, 270, Quality::kStandard, ""});
  return shared;
}

// Of the size of a golden image.
const Image& golden() {
  static const Image image = goldenRenderer().draw(samplePicture());
  return image;
}

// The golden image first: a Renderer draws over the image that it returned last.
Comparison judge(const Picture& picture) {
  const Image& want = golden();
  return compareImages(want, goldenRenderer().draw(picture));
}

TEST(Gate, PassesTheSameBytes) {
  const Comparison result = compareImages(golden(), golden());
  EXPECT_TRUE(result.passed);
  EXPECT_TRUE(result.identical);
}

TEST(Gate, PassesAFewFlippedPixelsAtEdges) {
  Image other = golden();
  for (int i = 0; i < 10; ++i) {
    const std::size_t pixel = static_cast<std::size_t>(480 * (20 + 20 * i) + 45 * i);
    other.rgb[3 * pixel] = static_cast<std::uint8_t>(other.rgb[3 * pixel] ^ 0x80);
  }
  const Comparison result = compareImages(golden(), other);
  EXPECT_TRUE(result.passed) << result.reason;
  EXPECT_FALSE(result.identical);
  EXPECT_EQ(result.strong, 10u);
}

TEST(Gate, FailsWhenOneBodyMovedByAPixel) {
  Picture moved = samplePicture();
  // 7.3 m away at 35 degrees and 270 lines: 270 / (2 tan 17.5 deg * 7.3) = 59 px per metre.
  moved.instances[10].position.x() += 1.0f / 59;
  EXPECT_FALSE(judge(moved).passed);
}

TEST(Gate, FailsWhenASmallBodyIsMissing) {
  Picture with = samplePicture();
  Instance small;
  small.primitive = Primitive::kSphere;
  small.size = Vec3f::Constant(0.12f);
  small.position = {0.4f, 1.4f, 1};
  with.instances.push_back(small);
  const Image& want = golden();
  const Comparison result = compareImages(goldenRenderer().draw(with), want);
  EXPECT_FALSE(result.passed);
  EXPECT_LT(result.visible, 200u);  // it is small
}

TEST(Gate, FailsWhenAColourIsOffByFourLevels) {
  Image other = golden();
  for (std::size_t i = 0; i < other.rgb.size(); i += 3)
    other.rgb[i] =
        static_cast<std::uint8_t>(other.rgb[i] > 127 ? other.rgb[i] - 4 : other.rgb[i] + 4);
  EXPECT_FALSE(compareImages(golden(), other).passed);
}

TEST(Gate, FailsOnABlankImage) {
  Image blank = golden();
  std::fill(blank.rgb.begin(), blank.rgb.end(), std::uint8_t{255});
  EXPECT_FALSE(compareImages(golden(), blank).passed);
  EXPECT_FALSE(compareImages(blank, golden()).passed);
}

TEST(Gate, FailsOnAnotherSize) {
  Image other{270, 480, golden().rgb};
  const Comparison result = compareImages(golden(), other);
  EXPECT_FALSE(result.passed);
  EXPECT_NE(result.reason.find("480 x 270"), std::string::npos);
}

TEST(Gate, FailsOnATileThatIsMoreThanAQuarterBadInALargeImage) {
  Image want{1920, 1080, {}};
  want.rgb.resize(3 * 1920 * 1080, 200);
  Image other = want;
  for (std::size_t i = 0; i < 64; ++i) other.rgb[3 * (i / 8 * 1920 + i % 8)] = 190;
  EXPECT_TRUE(compareImages(want, other).passed);
  other.rgb[3 * 9] = 190;
  const Comparison result = compareImages(want, other);
  EXPECT_FALSE(result.passed);
  EXPECT_EQ(result.worstTile, 65);
}

// 480 x 270 pixels: the budgets are 25 and 12 pixels.
TEST(Gate, CountsVisibleAndStrongPixelsApart) {
  const Image want{480, 270, std::vector<std::uint8_t>(3 * 480 * 270, 100)};
  const auto passes = [&want](std::size_t count, std::uint8_t level) {
    Image got = want;
    for (std::size_t i = 0; i < count; ++i) got.rgb[3 * 1000 * i] = level;
    return compareImages(want, got).passed;
  };
  EXPECT_TRUE(passes(120, 102));
  EXPECT_TRUE(passes(25, 103));
  EXPECT_FALSE(passes(26, 103));
  EXPECT_TRUE(passes(12, 133));
  EXPECT_FALSE(passes(13, 133));
}

TEST(Gate, PicturesTheDifference) {
  Image other = golden();
  other.rgb[0] = static_cast<std::uint8_t>(other.rgb[0] ^ 0x80);
  const Image difference = differenceImage(golden(), other);
  EXPECT_EQ(difference.rgb[1], 0);                  // dark red
  EXPECT_EQ(difference.rgb[3], difference.rgb[4]);  // grey
  EXPECT_THROW(differenceImage(golden(), Image{}), std::invalid_argument);
}

}  // namespace
}  // namespace render
