// Pivots, targets and errors; vectors s_i to the tip, d_ij to the centres of mass.
#include "scenes/view/arm_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/marked_text.h"

namespace scenes {
namespace {

using physics::Vec3;
using Pixels = Eigen::Vector2f;  // at 720 lines, y down

const render::Color kPivot{0.10f, 0.10f, 0.12f, 1}, kTip{0.05f, 0.30f, 0.65f, 1},
    kMass{0.80f, 0.40f, 0.00f, 1}, kError{0.80f, 0.08f, 0.10f, 1}, kTarget{0.00f, 0.50f, 0.35f, 1};
// Pixels at 720.
constexpr float kLabelSize = 25, kHalfLetter = 0.27f * kLabelSize, kHalfLine = 0.36f * kLabelSize,
                kFree = 6, kAngleDistance = 38, kShortestNamed = 40;

// Where the picture shows a point, counted from its middle.
Pixels onScreen(const render::Camera& camera, const render::Vec3f& point) {
  const render::Vec3f forward = (camera.target - camera.eye).normalized();
  const render::Vec3f right = forward.cross(camera.up).normalized();
  const render::Vec3f to = point - camera.eye;
  const float slope = std::tan(camera.fieldOfViewDegrees * static_cast<float>(M_PI) / 360);
  const float pixels = 360 / (slope * std::max(1e-6f, to.dot(forward)));
  return {pixels * to.dot(right), -pixels * to.dot(right.cross(forward))};
}

// "d₁₂" for the first and the second, as labels mark it.
std::string named(const char* letter, std::initializer_list<size_t> indices) {
  std::string digits;
  for (const size_t index : indices) digits += std::to_string(index + 1);
  return fmt::format("*{}*_{{{}}}", letter, digits);
}

float halfWidthOf(const std::string& text) {
  return kHalfLetter * static_cast<float>(render::letterCount(text));
}

struct ArmPen {
  render::Picture& picture;

  void dot(const Vec3& at, const render::Color& color, float diameter) const {
    picture.dots.push_back({at.cast<float>(), color, diameter});
  }
  void arrow(const Vec3& from, const Vec3& to, const render::Color& color) const {
    picture.lines.push_back({from.cast<float>(), to.cast<float>(), color, 2.5f, true, true});
  }
  // With its middle `offset` pixels from the point.
  void label(const Vec3& at, const Pixels& offset, const std::string& text,
             const render::Color& color) const {
    const Pixels corner(-halfWidthOf(text), 0);
    picture.labels.push_back({at.cast<float>(), text, offset + corner, color, kLabelSize});
  }
  Pixels screen(const Vec3& from, const Vec3& to) const {
    return onScreen(picture.camera, to.cast<float>()) -
           onScreen(picture.camera, from.cast<float>());
  }
  // Beside the line from `from` to `to`, this part of the way along, to its left as seen (1) or to
  // its right (-1).
  void beside(const Vec3& from, const Vec3& to, double part, float side, const std::string& text,
              const render::Color& color) const {
    const Pixels along = screen(from, to);
    const Pixels across =
        along.norm() > 1e-3f ? Pixels(along.y(), -along.x()).normalized().eval() : Pixels(0, -1);
    const float distance =
        kFree + halfWidthOf(text) * std::abs(across.x()) + kHalfLine * std::abs(across.y());
    label(from + part * (to - from), side * distance * across, text, color);
  }
};

void drawPivots(const ArmPen& pen, const physics::ArmReport& arm) {
  for (const Vec3& pivot : arm.pivots) pen.dot(pivot, kPivot, 8);
  pen.dot(arm.tip, kTip, 7);
}

// On the outer side of the bend.
void nameAngles(const ArmPen& pen, const physics::ArmReport& arm) {
  const size_t count = arm.pivots.size();
  for (size_t k = 0; k < count; ++k) {
    const Vec3& here = arm.pivots[k];
    Pixels inside = pen.screen(here, k + 1 < count ? arm.pivots[k + 1] : arm.tip).normalized();
    if (k > 0) inside += pen.screen(here, arm.pivots[k - 1]).normalized();
    const Pixels outside = inside.norm() > 0.05f ? (-inside).normalized().eval() : Pixels(0, -1);
    pen.label(here, kAngleDistance * outside, named("θ", {k}), kPivot);
  }
}

void drawTarget(const ArmPen& pen, const physics::ArmReport& arm) {
  const float length = pen.screen(arm.target, arm.tip).norm();
  if (length > 2) pen.arrow(arm.target, arm.tip, kError);
  if (length > kShortestNamed) pen.beside(arm.target, arm.tip, 0.5, -1, "δ*x*", kError);
  pen.dot(arm.target, kTarget, 9);
  pen.picture.labels.push_back({arm.target.cast<float>(), "target", {12, 0}, kTarget, kLabelSize});
}

void drawTips(const ArmPen& pen, const physics::ArmReport& arm) {
  for (size_t k = 0; k < arm.pivots.size(); ++k) {
    pen.arrow(arm.pivots[k], arm.tip, kTip);
    pen.beside(arm.pivots[k], arm.tip, 0.35, 1, named("s", {k}), kTip);
  }
}

// d_ij for the first `pivots` of i: one or two show what i and j mean, all could not be read.
void drawCentres(const ArmPen& pen, const physics::ArmReport& arm, size_t pivots) {
  const size_t count = arm.pivots.size();
  for (size_t i = 0; i < std::min(pivots, count); ++i) {
    for (size_t j = i; j < count; ++j) {
      pen.arrow(arm.pivots[i], arm.centres[j], kMass);
      pen.beside(arm.pivots[i], arm.centres[j], 0.6, 1, named("d", {i, j}), kMass);
    }
  }
  for (const Vec3& centre : arm.centres) pen.dot(centre, kMass, 7);
}

}  // namespace

void drawArms(const Simulation& simulation, const Overlays& overlays, render::Picture& picture) {
  const ArmPen pen{picture};
  const bool all = overlays.arms;
  const bool angles = all || overlays.armAngles, targets = all || overlays.armTargets;
  const bool tips = all || overlays.armTips, centres = all || overlays.armCentres;
  if (!angles && !targets && !tips && !centres) return;
  for (const physics::ArmReport& arm : simulation.arms()) {
    if (centres) drawCentres(pen, arm, all ? 1 : 2);
    if (tips) drawTips(pen, arm);
    if (angles) nameAngles(pen, arm);
    if (targets) drawTarget(pen, arm);
    drawPivots(pen, arm);
  }
}

}  // namespace scenes
