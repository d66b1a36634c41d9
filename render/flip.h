// FLIP: how different two images look to somebody who flips between them.
//
// P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A
// Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3 (2),
// 2020. Colours are blurred as the eye does at a distance, compared in a space where equal steps
// look equal, and what differs at edges and points weighs more.
#pragma once

#include <vector>

#include "render/image.h"

namespace render {

// The paper's standard: a 0.7 m wide screen of 3840 pixels at 0.7 m.
constexpr double kPixelsPerDegree = 67.0206;

// By pixel, from 0, alike, to 1. The two must have the same size, else std::invalid_argument.
std::vector<float> flipErrors(const Image& want, const Image& got,
                              double pixelsPerDegree = kPixelsPerDegree);

struct Flip {
  double mean = 0, percentile95 = 0;
};
Flip flip(const Image& want, const Image& got);

}  // namespace render
