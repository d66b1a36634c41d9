// The gate of the golden images: equal bytes, or a small budget of bad pixels.
//
// Another class of CPU flips a few pixels at edges by many levels, so neither the largest
// difference nor a mean tells it from a fault; the number of bad pixels does.
#pragma once

#include <cstddef>
#include <string>

#include "render/image.h"

namespace render {

// A pixel differs by its worst channel, in levels of 0...255.
struct Budget {
  int visibleLevels = 2;         // a pixel is bad above this
  double visibleShare = 0.0002;  // of all pixels, at most
  int strongLevels = 32;         // and very bad above this
  double strongShare = 0.0001;
  double tileShare = 0.25;  // of a tile of 16 x 16 pixels, at most
};

struct Comparison {
  bool passed = false;
  bool identical = false;
  std::size_t pixels = 0;
  std::size_t visible = 0, strong = 0;  // pixels above the two levels
  int largest = 0;                      // levels
  int worstTile = 0;                    // bad pixels of the worst tile
  int worstTileX = 0, worstTileY = 0;   // its upper left corner [px]
  std::string reason;                   // one line on what was found, passed or not
};

Comparison compareImages(const Image& want, const Image& got, const Budget& budget = {});

// The wanted image pale and grey, with bad pixels in orange and very bad ones in dark red. The two
// must have the same size, else std::invalid_argument.
Image differenceImage(const Image& want, const Image& got, const Budget& budget = {});

}  // namespace render
