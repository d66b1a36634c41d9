// Tries places around a point, nearest and most wanted first, and takes the one that covers least.
#include "scenes/view/label_placer.h"

#include <algorithm>
#include <cmath>

#include "render/marked_text.h"

namespace scenes {
namespace {

using Pixel = LabelPlacer::Pixel;
using render::Vec3f;

constexpr float kHeight = 720;
constexpr float kLetterWidth = 0.5f, kCapHeight = 0.7f;  // of a line's height
constexpr int kDirections = 16;
constexpr int kOutside = 8, kOverLabel = 6, kOverStroke = 2;  // what covering costs

// Distance from a rectangle to the nearest point of a segment, by samples a few pixels apart.
float distanceTo(const Pixel& low, const Pixel& high, const Pixel& from, const Pixel& to) {
  // Far-away points make long lines: no more samples than a picture has pixels to tell apart.
  const int samples =
      2 + static_cast<int>(std::min(1e3, static_cast<double>((to - from).norm()) / 3));
  float least = std::numeric_limits<float>::infinity();
  for (int i = 0; i <= samples; ++i) {
    const Pixel p = from + (to - from) * (static_cast<float>(i) / static_cast<float>(samples));
    const Pixel away = (low - p).cwiseMax(p - high).cwiseMax(Pixel::Zero());
    least = std::min(least, away.norm());
  }
  return least;
}

}  // namespace

LabelPlacer::LabelPlacer(const render::Camera& camera, double aspect)
    : eye_(camera.eye), ahead_((camera.target - camera.eye).normalized()) {
  right_ = ahead_.cross(camera.up).normalized();
  up_ = right_.cross(ahead_);
  width_ = kHeight * static_cast<float>(aspect);
  focal_ = kHeight / (2 * std::tan(camera.fieldOfViewDegrees * static_cast<float>(M_PI) / 360));
}

Pixel LabelPlacer::project(const Vec3f& point) const {
  const Vec3f d = point - eye_;
  const float depth = std::max(ahead_.dot(d), 1e-6f);
  return {0.5f * width_ + focal_ * right_.dot(d) / depth,
          0.5f * kHeight - focal_ * up_.dot(d) / depth};
}

void LabelPlacer::avoid(const render::Picture& picture) {
  for (const render::Line& line : picture.lines) {
    strokes_.push_back({project(line.from), project(line.to), line.width / 2});
  }
  for (const render::Dot& dot : picture.dots) {
    strokes_.push_back({project(dot.at), project(dot.at), dot.diameter / 2});
  }
}

void LabelPlacer::avoidUpperLeft(float width, float height) {
  taken_.push_back({Pixel::Zero(), {width, height}});
}

int LabelPlacer::cost(const Box& box) const {
  int sum = 0;
  if (box.low.minCoeff() < 2 || box.high.x() > width_ - 2 || box.high.y() > kHeight - 2) {
    sum += kOutside;
  }
  for (const Box& other : taken_) {
    const bool apart = (box.low.array() > other.high.array()).any() ||
                       (box.high.array() < other.low.array()).any();
    if (!apart) sum += kOverLabel;
  }
  for (const Stroke& stroke : strokes_) {
    if (distanceTo(box.low, box.high, stroke.from, stroke.to) < stroke.radius + 2) {
      sum += kOverStroke;
    }
  }
  return sum;
}

void LabelPlacer::put(const Wish& wish, float size, render::Picture& picture) {
  const Pixel at = project(wish.at);
  const Pixel half(0.5f * kLetterWidth * size * static_cast<float>(render::letterCount(wish.text)),
                   0.5f * kCapHeight * size);
  const float wanted = std::atan2(wish.toward.y(), wish.toward.x());
  Box best;
  int least = std::numeric_limits<int>::max();
  for (const float gap : {0.35f, 0.7f, 1.2f, 1.9f}) {
    for (int k = 0; k < kDirections && least > 0; ++k) {
      const int steps = (k + 1) / 2 * (k % 2 == 0 ? 1 : -1);
      const float angle = wanted + 2 * static_cast<float>(M_PI) * steps / kDirections;
      const Pixel toward(std::cos(angle), std::sin(angle));
      const float reach = std::min(half.x() / std::max(std::abs(toward.x()), 1e-6f),
                                   half.y() / std::max(std::abs(toward.y()), 1e-6f));
      const Pixel centre = at + (reach + gap * size) * toward;
      const Box box{centre - half, centre + half};
      const int now = cost(box);
      if (now < least) least = now, best = box;
    }
  }
  taken_.push_back(best);
  render::Label label;
  label.at = wish.at;
  label.text = wish.text;
  label.size = size;
  label.color = wish.color;
  label.anchor = 0.5f;
  const Pixel middle = 0.5f * (best.low + best.high);
  label.offset = Pixel(middle.x(), best.high.y()) - at;
  picture.labels.push_back(label);
}

}  // namespace scenes
