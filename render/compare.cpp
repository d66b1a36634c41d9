// Counts the pixels that differ, over the image and by tile.
#include "render/compare.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace render {
namespace {

constexpr int kTile = 16;

bool sameSize(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.rgb.size() == b.rgb.size();
}

int difference(const Image& a, const Image& b, std::size_t pixel) {
  int worst = 0;
  for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
    worst = std::max(worst, std::abs(static_cast<int>(a.rgb[i]) - static_cast<int>(b.rgb[i])));
  return worst;
}

void count(Comparison& result, const Image& want, const Image& got, const Budget& budget) {
  const int columns = (want.width + kTile - 1) / kTile;
  std::vector<int> tiles(static_cast<std::size_t>(columns * ((want.height + kTile - 1) / kTile)));
  for (std::size_t pixel = 0; pixel < result.pixels; ++pixel) {
    const int levels = difference(want, got, pixel);
    result.largest = std::max(result.largest, levels);
    if (levels > budget.strongLevels) ++result.strong;
    if (levels <= budget.visibleLevels) continue;
    ++result.visible;
    const int x = static_cast<int>(pixel) % want.width, y = static_cast<int>(pixel) / want.width;
    const int tile = y / kTile * columns + x / kTile;
    const int bad = ++tiles[static_cast<std::size_t>(tile)];
    if (bad <= result.worstTile) continue;
    result.worstTile = bad;
    result.worstTileX = x / kTile * kTile;
    result.worstTileY = y / kTile * kTile;
  }
}

std::string percent(std::size_t part, std::size_t whole) {
  char text[64];
  std::snprintf(text, sizeof text, "%zu pixels (%.4f %%)", part,
                100.0 * static_cast<double>(part) / static_cast<double>(whole));
  return text;
}

std::string sizeOf(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

void judge(Comparison& result, const Budget& budget) {
  const auto pixels = static_cast<double>(result.pixels);
  const std::string above = " differ by more than ";
  std::string found;
  const auto add = [&found](const std::string& text) {
    found += (found.empty() ? "" : "; ") + text;
  };
  if (static_cast<double>(result.visible) > budget.visibleShare * pixels)
    add(percent(result.visible, result.pixels) + above + std::to_string(budget.visibleLevels));
  if (static_cast<double>(result.strong) > budget.strongShare * pixels)
    add(percent(result.strong, result.pixels) + above + std::to_string(budget.strongLevels));
  if (result.worstTile > budget.tileShare * kTile * kTile)
    add(std::to_string(result.worstTile) + " bad pixels in the tile at " +
        std::to_string(result.worstTileX) + ", " + std::to_string(result.worstTileY));
  result.passed = found.empty();
  result.reason = result.passed ? "within the budget: " + percent(result.visible, result.pixels) +
                                      above + std::to_string(budget.visibleLevels)
                                : found;
}

}  // namespace

Comparison compareImages(const Image& want, const Image& got, const Budget& budget) {
  Comparison result;
  if (!sameSize(want, got)) {
    result.reason = "sizes differ: want " + sizeOf(want) + ", got " + sizeOf(got);
    return result;
  }
  result.pixels = want.rgb.size() / 3;
  result.identical = want.rgb == got.rgb;
  if (result.identical) {
    result.passed = true;
    result.reason = "identical";
    return result;
  }
  count(result, want, got, budget);
  judge(result, budget);
  return result;
}

Image differenceImage(const Image& want, const Image& got, const Budget& budget) {
  if (!sameSize(want, got))
    throw std::invalid_argument("difference of images of " + sizeOf(want) + " and " + sizeOf(got));
  Image image = want;
  for (std::size_t pixel = 0; 3 * pixel < image.rgb.size(); ++pixel) {
    std::uint8_t* const rgb = &image.rgb[3 * pixel];
    const int levels = difference(want, got, pixel);
    const auto pale = static_cast<std::uint8_t>(170 + (rgb[0] + rgb[1] + rgb[2]) / 9);
    std::fill(rgb, rgb + 3, pale);
    if (levels > budget.visibleLevels) {
      const bool strong = levels > budget.strongLevels;
      rgb[0] = strong ? 140 : 230;
      rgb[1] = strong ? 0 : 130;
      rgb[2] = 20;
    }
  }
  return image;
}

}  // namespace render
