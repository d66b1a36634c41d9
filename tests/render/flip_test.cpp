// FLIP against what its definition says.
#include "render/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace render {
namespace {

Image plain(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image image{width, height, {}};
  for (int k = 0; k < width * height; ++k) image.rgb.insert(image.rgb.end(), {r, g, b});
  return image;
}

TEST(Flip, IsNothingForTheSameImage) {
  const Image image = plain(40, 30, 200, 90, 10);
  EXPECT_EQ(flip(image, image).mean, 0);
}

// Black and white lie 100 apart in lightness, green and blue, which fill the range, 203.3 in all:
// (100 / 203.3)^0.7 = 0.6086 of the range is above 0.4 of it, where 0.95 is given.
TEST(Flip, IsTheSameEverywhereForPlainImages) {
  const std::vector<float> errors =
      flipErrors(plain(40, 30, 0, 0, 0), plain(40, 30, 255, 255, 255));
  const auto [low, high] = std::minmax_element(errors.begin(), errors.end());
  EXPECT_NEAR(*low, *high, 1e-4);
  EXPECT_NEAR(*low, 0.95 + 0.05 * (0.6086 - 0.4) / 0.6, 1e-4);
  EXPECT_NEAR(flipErrors(plain(9, 9, 0, 255, 0), plain(9, 9, 0, 0, 255))[40], 1, 1e-5);
}

TEST(Flip, DoesNotMindWhichImageIsFirst) {
  Image a = plain(50, 40, 128, 128, 128), b = a;
  for (int x = 20; x < 30; ++x) b.rgb[static_cast<std::size_t>(3 * (20 * 50 + x))] = 255;
  EXPECT_EQ(flipErrors(a, b), flipErrors(b, a));
  EXPECT_GT(flip(a, b).percentile95, 0);
}

TEST(Flip, SeesLessFromFurtherAway) {
  Image a = plain(60, 60, 128, 128, 128), b = a;
  for (std::size_t k = 0; k < b.rgb.size(); ++k) b.rgb[k] = k / 3 % 2 == 0 ? 158 : 98;  // stripes
  const auto mean = [&](double pixelsPerDegree) {
    double sum = 0;
    for (const float error : flipErrors(a, b, pixelsPerDegree)) sum += error;
    return sum / 3600;
  };
  EXPECT_LT(mean(60), mean(20));
}

TEST(Flip, RefusesImagesOfDifferentSizes) {
  EXPECT_THROW(flip(plain(4, 4, 0, 0, 0), plain(4, 5, 0, 0, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace render
