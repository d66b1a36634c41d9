// One frame of a race's film.
#include "app/race/race_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/base/numbers.h"
#include "app/race/race_table.h"

namespace app {

namespace {

using render::Color;
using render::Page;
using render::Pixel;

constexpr int kPanelWidth = 640, kHeight = 720;         // px, where nothing is asked for
constexpr float kTextShare = 22.0F / kPanelWidth;       // of a panel's width
constexpr float kTopLines = 5.2F, kBottomLines = 4.7F;  // above and below the pictures
constexpr float kLetter = 0.52F;                        // mean width of a letter, of its size
constexpr int kLeastPicture = 32;                       // px
const Color kInk(0.1F, 0.1F, 0.11F, 1), kQuiet(0.45F, 0.45F, 0.47F, 1), kBad(0.78F, 0.1F, 0.1F, 1),
    kFrame(0.8F, 0.8F, 0.8F, 1);

render::Image plain(int width, int height, const Color& color) {
  render::Image image{width, height, {}};
  image.rgb.resize(static_cast<std::size_t>(3 * width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const float part = color[static_cast<Eigen::Index>(i % 3)];
    image.rgb[i] = static_cast<std::uint8_t>(std::lround(255 * part));
  }
  return image;
}

// A star would slant what follows.
std::string escaped(const std::string& words) {
  std::string text;
  for (const char c : words) text += c == '*' ? std::string("\\*") : std::string(1, c);
  return text;
}

// Lays out one panel.
class Panel {
 public:
  Panel(const Race& race, const RaceLimits& limits, const RaceLayout& layout, int index, Page& page)
      : race_(race),
        limits_(limits),
        layout_(layout),
        page_(page),
        left_(layout.left(index)),
        track_(race.tracks[static_cast<std::size_t>(index)]) {}

  void add(int frame, render::Image image) {
    const float u = layout_.textSize, top = static_cast<float>(layout_.top);
    write(0, top - 1.65F * u, track_.entry.title, 1.15F * u, kInk);
    write(0, top - 0.45F * u, track_.entry.setup, 0.85F * u, kQuiet);
    if (!track_.ran()) return refuse();
    page_.tiles.push_back({left_, layout_.top, std::move(image)});
    const bool broken = track_.broke && frame >= track_.broke->frame;
    outline(broken ? kBad : kFrame, broken ? 0.25F : 0);
    const std::size_t last = track_.samples.size() - 1;
    numbers(frame, track_.samples[std::min(static_cast<std::size_t>(frame), last)]);
    status(broken);
  }

 private:
  float lineBelow(float lines) const {
    return static_cast<float>(layout_.top + layout_.pictureHeight) + lines * layout_.textSize;
  }

  // As large as asked for, or as fits from `x` to the panel's end.
  void write(float x, float y, const std::string& words, float size, const Color& color) {
    const float room = static_cast<float>(layout_.panelWidth) - x;
    const float wanted = kLetter * size * static_cast<float>(words.size());
    page_.texts.push_back({Pixel(static_cast<float>(left_) + x, y), escaped(words),
                           wanted > room ? size * room / wanted : size, 0, color, false});
  }

  void refuse() {
    page_.tiles.push_back(
        {left_, layout_.top,
         plain(layout_.panelWidth, layout_.pictureHeight, Color(0.93F, 0.93F, 0.93F, 1))});
    const float u = layout_.textSize;
    float y = static_cast<float>(layout_.top) + 0.42F * static_cast<float>(layout_.pictureHeight);
    write(u, y, "does not run this scene:", u, kInk);
    std::istringstream words(track_.entry.refusal);
    std::string line;
    const auto flush = [&] { write(u, y += 1.35F * u, line, u, kInk); };
    const auto most =
        static_cast<std::size_t>((static_cast<float>(layout_.panelWidth) - 2 * u) / (kLetter * u));
    for (std::string word; words >> word; line += (line.empty() ? "" : " ") + word) {
      if (line.size() + word.size() + 1 <= most) continue;
      flush();
      line.clear();
    }
    flush();
  }

  void outline(const Color& color, float lines) {
    const int w = layout_.panelWidth, h = layout_.pictureHeight;
    const int t = std::max(1, static_cast<int>(lines * layout_.textSize));
    page_.tiles.push_back({left_, layout_.top, plain(w, t, color)});
    page_.tiles.push_back({left_, layout_.top + h - t, plain(w, t, color)});
    page_.tiles.push_back({left_, layout_.top, plain(t, h, color)});
    page_.tiles.push_back({left_ + w - t, layout_.top, plain(t, h, color)});
  }

  void number(int column, int line, const char* name, const std::string& value, bool bad) {
    const float u = layout_.textSize;
    const float x = static_cast<float>(column) * 0.5F * static_cast<float>(layout_.panelWidth);
    const float y = lineBelow(1.35F * static_cast<float>(line + 1));
    write(x, y, name, u, kQuiet);
    write(x + (column == 0 ? 6.8F : 4.8F) * u, y, value, u, bad ? kBad : kInk);
  }

  void numbers(int frame, const RaceSample& sample) {
    const auto measure = [](bool there, double length, double share) {
      return there ? lengthText(length) + ", " + shareText(share) : std::string("none");
    };
    number(0, 0, "mean time",
           fmt::format("{:.3g} ms", recentMilliseconds(track_, frame, race_.scene.fps)), false);
    number(0, 1, "energy change", energyText(sample.energyChange),
           race_.energyNote.empty() && sample.energyChange > limits_.energy);
    number(1, 0, "overlap", measure(race_.hasContacts, sample.overlap, sample.overlapShare),
           sample.overlapShare > limits_.overlap);
    number(1, 1, "joint gap", measure(race_.hasJoints, sample.gap, sample.gapShare),
           sample.gapShare > limits_.gap);
  }

  static std::string energyText(double change) {
    const std::string share = shareText(change);
    return (change > 0 && share != shareText(0) ? "+" : "") + share;
  }

  void status(bool broken) {
    const float y = lineBelow(4.15F), u = layout_.textSize;
    if (!broken) return write(0, y, "holds", 1.1F * u, kQuiet);
    const double time = static_cast<double>(track_.broke->frame) / race_.scene.fps;
    write(0, y, fmt::format("BROKE at {:.2f} s: {}", time, track_.broke->what), 1.1F * u, kBad);
  }

  const Race& race_;
  const RaceLimits& limits_;
  const RaceLayout& layout_;
  Page& page_;
  int left_;
  const RaceTrack& track_;
};

}  // namespace

RaceLayout layoutRace(int panels, int width, int height) {
  RaceLayout layout;
  layout.panels = panels;
  layout.width = width > 0 ? width : panels * kPanelWidth;
  layout.height = height > 0 ? height : kHeight;
  const float text = kTextShare * static_cast<float>(layout.width) / static_cast<float>(panels);
  layout.gap = static_cast<int>(0.6F * text);
  layout.panelWidth = (layout.width - layout.gap * (panels + 1)) / panels;
  layout.textSize = kTextShare * static_cast<float>(layout.panelWidth);
  layout.top = static_cast<int>(kTopLines * layout.textSize);
  layout.pictureHeight =
      layout.height - layout.top - static_cast<int>(kBottomLines * layout.textSize);
  if (layout.panelWidth < kLeastPicture || layout.pictureHeight < kLeastPicture) {
    throw scenes::InputError(fmt::format("--size {}x{}: {} pictures side by side leave no room",
                                         layout.width, layout.height, panels));
  }
  return layout;
}

render::Page racePage(const Race& race, const RaceLimits& limits, const RaceLayout& layout,
                      int frame, std::vector<render::Image> images) {
  Page page;
  page.width = layout.width;
  page.height = layout.height;
  const float u = layout.textSize;
  const Pixel at(static_cast<float>(layout.gap), 1.5F * u);
  page.texts.push_back({at, escaped(race.scene.title), 1.25F * u, 0, kInk, false});
  const double time = static_cast<double>(frame) / race.scene.fps;
  page.texts.push_back({Pixel(static_cast<float>(layout.width - layout.gap), at.y()),
                        fmt::format("{:.2f} s", time), 1.25F * u, 1, kInk, false});
  for (int k = 0; k < layout.panels; ++k) {
    Panel(race, limits, layout, k, page).add(frame, std::move(images[static_cast<std::size_t>(k)]));
  }
  return page;
}

}  // namespace app
