// What is drawn flat, as it was asked for: for files that keep lines as lines, letters as letters.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "render/picture.h"

namespace render {

// In pixels from the upper left.
struct Ink {
  enum class Kind { kText, kCurve, kArea, kDisc };
  Kind kind = Kind::kCurve;
  // A text's baseline begins at the first, a disc's centre is it.
  std::vector<Eigen::Vector2f> points = {};
  Color color{0, 0, 0, 1};
  float size = 1;  // thickness of a curve, height of a line of text, radius of a disc
  std::string words = {};
  bool slanted = false, upward = false, halo = false;  // of a text
  bool closed = false;                                 // of a curve
};

}  // namespace render
