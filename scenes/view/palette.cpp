// The palette: Okabe and Ito's hues with less chroma and more even lightness, and two tones of
// each.
#include "scenes/view/palette.h"

#include <array>
#include <cstdio>

namespace scenes {
namespace {

struct Hue {
  const char* name;
  std::array<float, 3> plain, light;  // sRGB
};

constexpr Hue kHues[] = {
    {"blue", {0.20f, 0.45f, 0.70f}, {0.47f, 0.66f, 0.84f}},
    {"orange", {0.88f, 0.60f, 0.17f}, {0.95f, 0.77f, 0.48f}},
    {"green", {0.14f, 0.60f, 0.47f}, {0.45f, 0.76f, 0.66f}},
    {"vermilion", {0.80f, 0.38f, 0.17f}, {0.91f, 0.61f, 0.45f}},
    {"sky", {0.42f, 0.68f, 0.86f}, {0.67f, 0.83f, 0.93f}},
    {"purple", {0.73f, 0.47f, 0.63f}, {0.86f, 0.69f, 0.80f}},
    {"yellow", {0.90f, 0.83f, 0.36f}, {0.95f, 0.91f, 0.63f}},
};
constexpr int kCount = static_cast<int>(std::size(kHues));

render::Color opaque(const std::array<float, 3>& rgb) { return {rgb[0], rgb[1], rgb[2], 1}; }

}  // namespace

render::Color familyColor(Pattern pattern, int hue, int index, int row) {
  const Hue& own = kHues[hue % kCount];
  switch (pattern) {
    case Pattern::kAlternate:
      return opaque(index % 2 == 0 ? own.plain : own.light);
    case Pattern::kVaried: {
      const int step = hue + index;
      return opaque(step / kCount % 2 == 0 ? kHues[step % kCount].plain
                                           : kHues[step % kCount].light);
    }
    case Pattern::kRows: {
      const Hue& ofRow = kHues[(hue + row) % kCount];
      return opaque((index + row) % 2 == 0 ? ofRow.plain : ofRow.light);
    }
    case Pattern::kSingle:
      break;
  }
  return opaque(own.plain);
}

render::Color fixedColor() { return {0.66f, 0.66f, 0.65f, 1}; }

std::optional<render::Color> namedColor(const std::string& text) {
  for (const Hue& hue : kHues) {
    if (text == hue.name) return opaque(hue.plain);
  }
  if (text == "grey") return fixedColor();
  if (text == "white") return opaque({1, 1, 1});
  if (text == "black") return opaque({0, 0, 0});
  const bool isHex = text.starts_with('#') && (text.size() == 7 || text.size() == 9) &&
                     text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  unsigned r = 0, g = 0, b = 0, a = 255;
  if (!isHex) return std::nullopt;
  std::sscanf(text.c_str(), "#%2x%2x%2x%2x", &r, &g, &b, &a);
  const auto unit = [](unsigned value) { return static_cast<float>(value) / 255.0f; };
  return render::Color{unit(r), unit(g), unit(b), unit(a)};
}

std::vector<std::string> colorNames() {
  std::vector<std::string> names;
  for (const Hue& hue : kHues) names.emplace_back(hue.name);
  names.insert(names.end(), {"grey", "white", "black"});
  return names;
}

}  // namespace scenes
