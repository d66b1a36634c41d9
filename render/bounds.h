// Where on the screen and in the shadow map there can be anything at all: passes over pixels are
// cut to it, since pixels are what a software rasteriser pays for.
#pragma once

#include "render/frame.h"
#include "render/picture.h"

namespace render {

struct Bounds {  // shares of the width and height, from the lower left; low > high: nothing
  Eigen::Array2f low{1, 1}, high{0, 0};

  bool empty() const { return (low >= high).any(); }
  bool operator==(const Bounds& other) const {
    return (low == other.low).all() && (high == other.high).all();
  }
  void include(const Eigen::Array2f& from, const Eigen::Array2f& to);
};

// Encloses the bodies and surfaces; all of the screen when one reaches behind the near plane or
// lines are drawn among the bodies.
Bounds screenBoundsOf(const Picture& picture, const Frame& frame);
Bounds shadowBoundsOf(const Frame& frame);

}  // namespace render
