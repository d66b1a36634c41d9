// Colours that tell bodies apart, for readers who do not see all of them: after Okabe and Ito,
// toned for print.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/picture.h"

namespace scenes {

// How the bodies of one generator are coloured.
enum class Pattern {
  kSingle,     // each body alone: the next hue
  kAlternate,  // two tones of one hue in turn
  kVaried,     // all hues in turn
  kRows,       // a hue for each row of equal height, two tones in turn along it
};

// `hue` counts families of bodies, `index` the bodies within one, `row` their rows.
render::Color familyColor(Pattern pattern, int hue, int index, int row = 0);
render::Color fixedColor();

// "#rrggbb", "#rrggbbaa" or the name of a hue.
std::optional<render::Color> namedColor(const std::string& text);
std::vector<std::string> colorNames();

}  // namespace scenes
