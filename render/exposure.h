// The pictures whose mean is one of quality paper: each a little aside by less than a pixel, lit
// from one point of the light and from a few points of the sky, all of them spread evenly. The mean
// is free of steps along edges, shadows are as soft as the light is wide, and it is dark where
// little of the sky is seen. Plain numbers, no OpenGL.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace render {

inline constexpr int kSkies = 3;  // points of the sky in one exposure

struct Exposure {
  Eigen::Vector2f aside = Eigen::Vector2f::Zero();    // of the picture [px], within half a pixel
  Eigen::Vector2f onLight = Eigen::Vector2f::Zero();  // on the light's disc, of radius 1
  std::array<Eigen::Vector3f, kSkies> sky;            // unit vectors toward it, y > 0
};

std::vector<Exposure> spreadExposures(int count);

}  // namespace render
