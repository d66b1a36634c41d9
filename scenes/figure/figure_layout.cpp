// Rows of cells from the upper left; a label spans the cells of its panel in its first row.
#include "scenes/figure/figure_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "render/marked_text.h"

namespace scenes {
namespace {

// In lines of text.
constexpr double kGutter = 0.5, kLabelGap = 1.05, kLineStep = 1.2, kRowGap = 0.55, kEdge = 0.1;
constexpr float kMeanLetter = 0.53f;  // mean of the shipped font
constexpr float kTextSize = 34;       // px at the sheet's own width

struct Row {
  size_t begin = 0, end = 0;  // tiles
};

std::vector<Row> rowsOf(const std::vector<FigureTile>& tiles, int columns) {
  std::vector<Row> rows;
  int used = columns + 1;
  for (size_t i = 0; i < tiles.size(); ++i) {
    if (used + tiles[i].span > columns) {
      rows.push_back({i, i});
      used = 0;
    }
    used += tiles[i].span;
    rows.back().end = i + 1;
  }
  return rows;
}

const std::string& labelOf(const FigureSheet& sheet, const FigureTile& tile) {
  const auto index = static_cast<size_t>(tile.index);
  return tile.isPlot ? sheet.plots[index].label : sheet.panels[index].label;
}

class Builder {
 public:
  Builder(const FigureSheet& sheet, const std::vector<FigureTile>& tiles, int columns, int width,
          float textSize)
      : sheet_(sheet), tiles_(tiles), columns_(columns) {
    layout_.width = width;
    const float share = static_cast<float>(width) / static_cast<float>(sheet.width);
    layout_.textSize = textSize > 0 ? textSize : kTextSize * share;
    gutter_ = lines(kGutter);
    cell_ = (width - (columns - 1) * gutter_) / columns;
    for (const FigureTile& tile : tiles) panels_ += tile.first;
  }

  FigureLayout build() {
    int y = 0;
    for (const Row& row : rowsOf(tiles_, columns_)) {
      if (y > 0) y += lines(kRowGap);
      y = addRow(row, y);
    }
    layout_.height = y;
    return std::move(layout_);
  }

 private:
  int lines(double count) const { return static_cast<int>(std::lround(count * layout_.textSize)); }

  int addRow(const Row& row, int y) {
    const auto widthOf = [&](const FigureTile& tile) {
      return tile.span * cell_ + (tile.span - 1) * gutter_;
    };
    int height = 0, x = 0;
    for (size_t i = row.begin; i < row.end; ++i) {
      const double wanted =
          tiles_[i].aspect ? widthOf(tiles_[i]) / *tiles_[i].aspect : cell_ / sheet_.aspect;
      height = std::max(height, static_cast<int>(std::lround(wanted)));
    }
    for (size_t i = row.begin; i < row.end; ++i) {
      const int width = widthOf(tiles_[i]);
      layout_.cells.push_back({x, y, width, height});
      x += width + gutter_;
    }
    int most = 0;
    for (size_t i = row.begin; i < row.end; ++i) {
      if (tiles_[i].first) most = std::max(most, addLabel(row, i, y + height));
    }
    return y + height + (most > 0 ? lines(kLabelGap + (most - 1) * kLineStep + 0.35) : 0);
  }

  // Returns its number of lines.
  int addLabel(const Row& row, size_t tile, int bottom) {
    const std::string letter = panels_ > 1 ? fmt::format("({}) ", letter_++) : "";
    const std::string& label = labelOf(sheet_, tiles_[tile]);
    if (letter.empty() && label.empty()) return 0;
    size_t last = tile;
    while (last + 1 < row.end && !tiles_[last + 1].first) ++last;
    const Rectangle &from = layout_.cells[tile], &to = layout_.cells[last];
    int count = 0;
    for (const std::string& line :
         wrap(letter + label, layout_.textSize, to.x + to.width - from.x)) {
      render::Page::Text text;
      text.words = line;
      text.size = layout_.textSize;
      text.at = {static_cast<float>(from.x + lines(kEdge)),
                 static_cast<float>(bottom + lines(kLabelGap + kLineStep * count++))};
      layout_.labels.push_back(text);
    }
    return count;
  }

  const FigureSheet& sheet_;
  const std::vector<FigureTile>& tiles_;
  const int columns_;
  int gutter_ = 0, cell_ = 0, panels_ = 0;
  char letter_ = 'a';
  FigureLayout layout_;
};

}  // namespace

FigureLayout layOut(const FigureSheet& sheet, const std::vector<FigureTile>& tiles, int columns,
                    int width, float textSize) {
  return Builder(sheet, tiles, columns, width, textSize).build();
}

std::vector<std::string> wrap(const std::string& words, float size, int width) {
  const int letters =
      std::max(1, static_cast<int>(static_cast<float>(width) / (kMeanLetter * size)));
  std::vector<std::string> lines;
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    const bool fits = !lines.empty() && render::letterCount(lines.back() + " " + word) <= letters;
    if (fits)
      lines.back() += " " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

std::string stampOf(const FigurePanel& panel, const Scene& scene, int frame, bool several) {
  using Stamp = FigurePanel::Stamp;
  const Stamp stamp = panel.stamp != Stamp::kAuto ? panel.stamp
                      : several                   ? Stamp::kTime
                                                  : Stamp::kNone;
  if (stamp == Stamp::kNone) return "";
  if (stamp == Stamp::kIteration) {
    const int sweeps = frame * scene.settings.substepCount() * scene.settings.iterations;
    return sweeps == 0 ? "start" : fmt::format("{} iteration{}", sweeps, sweeps == 1 ? "" : "s");
  }
  return fmt::format("*t* = {:.2f} s", static_cast<double>(frame) / scene.fps);
}

}  // namespace scenes
