// Lines, arrows and dots of the world, with a width in pixels.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "render/frame.h"
#include "render/gl.h"
#include "render/picture.h"

namespace render {

class Strokes {
 public:
  Strokes();

  void arrange(const Picture& picture, const Frame& frame);
  void drawHidden() const;  // those that bodies hide: tests depth, writes none
  void drawOnTop() const;   // the rest

 private:
  struct StrokeVertex {
    std::array<float, 3> at;     // normalised device coordinates
    std::array<float, 4> shape;  // along, across, length [px]; 1: round ends
    std::array<float, 2> radii;  // at the start and the end [px]
    std::array<float, 4> color;
  };
  struct End {  // a point on the screen
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
    float depth = 0;
  };

  bool project(const Frame& frame, Vec3f from, Vec3f to, End& start, End& end) const;
  void addLine(const Frame& frame, const Line& line);
  void addDot(const Frame& frame, const Dot& dot);
  void addStroke(const Frame& frame, const End& start, const End& end, float startRadius,
                 float endRadius, bool round, const Color& color);
  void draw(std::size_t first, std::size_t count) const;

  GLuint program_ = 0, array_ = 0, buffer_ = 0;
  std::vector<StrokeVertex> vertices_;
  std::size_t hidden_ = 0;  // the first vertices are those that bodies hide
};

}  // namespace render
