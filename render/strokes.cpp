// Projects strokes on the CPU and draws each as one smooth-edged rectangle.
#include "render/strokes.h"

#include <algorithm>

#include "render/shaders.h"

namespace render {
namespace {

constexpr float kHeadLength = 4.5f, kHeadRadius = 1.75f;  // of an arrow, in line widths
constexpr float kSmallestHead = 2;  // line width that a head needs [px at 720]

Eigen::Vector4f clipOf(const Frame& frame, const Vec3f& p) {
  return frame.block.toClip * p.homogeneous();
}

}  // namespace

Strokes::Strokes()
    : program_(makeProgram(kStrokeVertex, kStrokeFragment)),
      array_(makeVertexArray()),
      buffer_(makeBuffer()) {
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  setAttribute(0, 3, sizeof(StrokeVertex), offsetof(StrokeVertex, at));
  setAttribute(1, 4, sizeof(StrokeVertex), offsetof(StrokeVertex, shape));
  setAttribute(2, 2, sizeof(StrokeVertex), offsetof(StrokeVertex, radii));
  setAttribute(3, 4, sizeof(StrokeVertex), offsetof(StrokeVertex, color));
}

// Cuts what is behind the near plane; false when nothing remains.
bool Strokes::project(const Frame& frame, Vec3f from, Vec3f to, End& start, End& end) const {
  const float a = frame.depthOf(from) - frame.nearest, b = frame.depthOf(to) - frame.nearest;
  if (a < 0 && b < 0) return false;
  const Vec3f cut = a == b ? from : (from + (to - from) * (a / (a - b))).eval();
  if (a < 0) from = cut;
  if (b < 0) to = cut;
  const auto onScreen = [&frame](const Vec3f& p) {
    const Eigen::Vector4f clip = clipOf(frame, p);
    const Eigen::Vector2f ndc = clip.head<2>() / clip.w();
    return End{{(ndc.x() * 0.5f + 0.5f) * static_cast<float>(frame.width),
                (ndc.y() * 0.5f + 0.5f) * static_cast<float>(frame.height)},
               clip.z() / clip.w()};
  };
  start = onScreen(from);
  end = onScreen(to);
  return true;
}

void Strokes::addStroke(const Frame& frame, const End& start, const End& end, float startRadius,
                        float endRadius, bool round, const Color& color) {
  const Eigen::Vector2f span = end.pixel - start.pixel;
  const float length = span.norm();
  const Eigen::Vector2f along = length > 1e-3f ? (span / length).eval() : Eigen::Vector2f(1, 0);
  const Eigen::Vector2f across(-along.y(), along.x());
  const float reach = std::max(startRadius, endRadius) + 1, extra = round ? reach : 1;
  const auto corner = [&](bool atEnd, float side) {
    const End& base = atEnd ? end : start;
    const float forward = atEnd ? extra : -extra;
    const Eigen::Vector2f p = base.pixel + forward * along + side * reach * across;
    return StrokeVertex{{2 * p.x() / static_cast<float>(frame.width) - 1,
                         2 * p.y() / static_cast<float>(frame.height) - 1, base.depth},
                        {forward + (atEnd ? length : 0), side * reach, length, round ? 1.0f : 0.0f},
                        {startRadius, endRadius},
                        {color.x(), color.y(), color.z(), color.w()}};
  };
  for (const auto& [atEnd, side] : {std::pair{false, -1.0f},
                                    {true, -1.0f},
                                    {true, 1.0f},
                                    {false, -1.0f},
                                    {true, 1.0f},
                                    {false, 1.0f}})
    vertices_.push_back(corner(atEnd, side));
}

void Strokes::addLine(const Frame& frame, const Line& line) {
  End start, end;
  if (!project(frame, line.from, line.to, start, end)) return;
  const float radius = line.width * frame.scale / 2;
  const float length = (end.pixel - start.pixel).norm();
  if (!line.arrow || length < 1e-3f) {
    addStroke(frame, start, end, radius, radius, true, line.color);
    return;
  }
  const float width = std::max(line.width, kSmallestHead) * frame.scale;
  const float head = std::min(kHeadLength * width, length);
  End neck;
  neck.pixel = end.pixel + (start.pixel - end.pixel) * (head / length);
  neck.depth = end.depth + (start.depth - end.depth) * (head / length);
  if (head < length) addStroke(frame, start, neck, radius, radius, false, line.color);
  addStroke(frame, neck, end, kHeadRadius * width * head / (kHeadLength * width), 0, false,
            line.color);
}

void Strokes::addDot(const Frame& frame, const Dot& dot) {
  End at, same;
  if (!project(frame, dot.at, dot.at, at, same)) return;
  const float radius = dot.diameter * frame.scale / 2;
  const Color rim(1, 1, 1, 0.85f * dot.color.w());
  addStroke(frame, at, at, radius + 1.2f * frame.scale, radius + 1.2f * frame.scale, true, rim);
  addStroke(frame, at, at, radius, radius, true, dot.color);
}

void Strokes::arrange(const Picture& picture, const Frame& frame) {
  vertices_.clear();
  for (const Line& line : picture.lines)
    if (!line.onTop) addLine(frame, line);
  hidden_ = vertices_.size();
  for (const Line& line : picture.lines)
    if (line.onTop) addLine(frame, line);
  for (const Dot& dot : picture.dots) addDot(frame, dot);
  if (vertices_.empty()) return;
  fillBuffer(GL_ARRAY_BUFFER, buffer_, vertices_, GL_STREAM_DRAW);
}

void Strokes::draw(std::size_t first, std::size_t count) const {
  if (count == 0) return;
  glUseProgram(program_);
  glBindVertexArray(array_);
  glEnable(GL_BLEND);
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(count));
  glDisable(GL_BLEND);
}

void Strokes::drawHidden() const {
  glDepthMask(GL_FALSE);
  draw(0, hidden_);
  glDepthMask(GL_TRUE);
}

void Strokes::drawOnTop() const { draw(hidden_, vertices_.size() - hidden_); }

}  // namespace render
