// Flat drawing over the picture: text, rectangles and curves, in pixels from the upper left.
// Dear ImGui's draw lists and font atlas without its context: nothing is shared between threads.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "render/ink.h"
#include "render/picture.h"

namespace render {

using Pixel = Eigen::Vector2f;

class Canvas {
 public:
  // A TrueType file; throws std::runtime_error when it cannot be read. The context is current.
  explicit Canvas(const std::string& fontFile);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void begin(int width, int height);
  void draw();  // all since `begin`, into the framebuffer that is bound

  // From now on what is drawn is also put there; null: no longer.
  void record(std::vector<Ink>* ink);

  // Text sits on its baseline, which starts at `at`; `size` is the height of a line.
  void text(const Pixel& at, float size, const Color& color, const std::string& words);
  // With a light rim, to be read over anything.
  void textWithHalo(const Pixel& at, float size, const Color& color, const std::string& words);
  float widthOf(const std::string& words, float size);

  // Text with marks: "p_{i}" lowers i, "m^{2}" raises 2, "*x*" slants x; "\\*" is a star.
  void markedText(const Pixel& at, float size, const Color& color, const std::string& words,
                  bool halo = false);
  float widthOfMarked(const std::string& words, float size);
  // The same, read from below: `at` is where the baseline starts, at the lower end.
  void markedTextUpward(const Pixel& at, float size, const Color& color, const std::string& words);

  void fill(const Pixel& from, const Pixel& to, const Color& color, float rounding = 0);
  void outline(const Pixel& from, const Pixel& to, const Color& color, float thickness,
               float rounding = 0);
  void curve(const std::vector<Pixel>& points, const Color& color, float thickness);
  void dashedCurve(const std::vector<Pixel>& points, const Color& color, float thickness,
                   float dash, float gap);
  void disc(const Pixel& centre, float radius, const Color& color);
  void convexArea(const std::vector<Pixel>& corners, const Color& color);  // clockwise

 private:
  float runs(const Pixel& at, float size, const Color* color, const std::string& words, bool halo);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
