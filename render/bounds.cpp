// Bounds of the balls around the bodies.
#include "render/bounds.h"

#include <algorithm>

namespace render {
namespace {

const Eigen::Array2f kLow(0, 0), kHigh(1, 1);

bool drawnAmongBodies(const Line& line) { return !line.onTop; }

// The widest that (center +- radius) / (depth +- radius) can be.
void includeBall(Bounds& bounds, const Frame& frame, const Vec3f& center, float radius) {
  const float depth = frame.depthOf(center);
  if (depth - radius <= frame.nearest) {
    bounds.include(kLow, kHigh);
    return;
  }
  const Vec3f offset = center - frame.eye;
  const Eigen::Array2f middle(frame.right.dot(offset), frame.up.dot(offset));
  const Eigen::Array2f perPixel(frame.pixelsPerMetre / static_cast<float>(frame.width),
                                frame.pixelsPerMetre / static_cast<float>(frame.height));
  const Eigen::Array2f from = perPixel * (middle - radius), to = perPixel * (middle + radius);
  const float near = 1 / (depth - radius), far = 1 / (depth + radius);
  bounds.include(0.5f + (from * near).min(from * far), 0.5f + (to * near).max(to * far));
}

}  // namespace

void Bounds::include(const Eigen::Array2f& from, const Eigen::Array2f& to) {
  low = low.min(from.max(kLow));
  high = high.max(to.min(kHigh));
}

Bounds screenBoundsOf(const Picture& picture, const Frame& frame) {
  Bounds bounds;
  if (std::any_of(picture.lines.begin(), picture.lines.end(), drawnAmongBodies))
    bounds.include(kLow, kHigh);
  for (const Ball& ball : frame.balls) includeBall(bounds, frame, ball.center, ball.radius);
  return bounds;
}

Bounds shadowBoundsOf(const Frame& frame) {
  Bounds bounds;
  const float perMetre = frame.block.toShadow.block<1, 3>(0, 0).norm();
  for (const Ball& ball : frame.balls) {
    const Eigen::Vector4f at = frame.block.toShadow * ball.center.homogeneous();
    const float radius = ball.radius * perMetre;
    bounds.include(at.head<2>().array() - radius, at.head<2>().array() + radius);
  }
  return bounds;
}

}  // namespace render
