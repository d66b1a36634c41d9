// A curve in dashes, each a curve of its own.
#include "render/canvas.h"

namespace render {

// Dashes run on around the corners.
void Canvas::dashedCurve(const std::vector<Pixel>& points, const Color& color, float thickness,
                         float dash, float gap) {
  std::vector<Pixel> piece;
  float left = dash;
  bool drawn = true;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    Pixel at = points[i];
    float length = (points[i + 1] - at).norm();
    if (drawn && piece.empty()) piece.push_back(at);
    while (length > left) {
      at += (points[i + 1] - at) * (left / length);
      length -= left;
      if (drawn) {
        piece.push_back(at);
        curve(piece, color, thickness);
        piece.clear();
      } else {
        piece.push_back(at);
      }
      drawn = !drawn;
      left = drawn ? dash : gap;
    }
    left -= length;
    if (drawn) piece.push_back(points[i + 1]);
  }
  curve(piece, color, thickness);
}

}  // namespace render
