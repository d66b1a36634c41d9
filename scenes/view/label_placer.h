// Letters beside the lines and dots of a picture, where they cover neither these nor each other.
#pragma once

#include <string>
#include <vector>

#include "render/picture.h"

namespace scenes {

// All in pixels of a picture of 720 lines, from the upper left.
class LabelPlacer {
 public:
  using Pixel = Eigen::Vector2f;

  LabelPlacer(const render::Camera& camera, double aspect);

  // What letters keep off: everything drawn so far.
  void avoid(const render::Picture& picture);

  void avoidUpperLeft(float width, float height);

  struct Wish {
    render::Vec3f at = render::Vec3f::Zero();  // what the letters name
    Pixel toward = {0, -1};  // the side they should be on, as a direction on the screen
    std::string text;
    render::Color color{0.1f, 0.1f, 0.1f, 1};
  };
  // Adds the label to the picture, on the freest place around `at`; `size` is a line's height.
  void put(const Wish& wish, float size, render::Picture& picture);

  Pixel project(const render::Vec3f& point) const;

 private:
  struct Box {
    Pixel low = Pixel::Zero(), high = Pixel::Zero();
  };
  struct Stroke {
    Pixel from = Pixel::Zero(), to = Pixel::Zero();
    float radius = 0;
  };
  int cost(const Box& box) const;  // how much it would cover

  render::Vec3f eye_, right_, up_, ahead_;
  float width_, focal_;  // of the picture; pixels per unit slope
  std::vector<Stroke> strokes_;
  std::vector<Box> taken_;
};

}  // namespace scenes
