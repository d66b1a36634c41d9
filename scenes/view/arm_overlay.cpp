// Pivots, targets and errors; vectors s_i to the tip, d_ij to the centres of mass.
#include "scenes/view/arm_overlay.h"

#include <algorithm>
#include <cmath>

namespace scenes {
namespace {

using physics::Vec3;
using Pixels = Eigen::Vector2f;  // at 720 lines, y down

const render::Color kPivot{0.10f, 0.10f, 0.12f, 1}, kTip{0.05f, 0.30f, 0.65f, 1},
    kMass{0.80f, 0.40f, 0.00f, 1}, kError{0.80f, 0.08f, 0.10f, 1}, kTarget{0.00f, 0.50f, 0.35f, 1};
constexpr float kLabelSize = 20, kLabelDistance = 15, kAngleDistance = 36,
                kShortestNamed = 40;  // pixels at 720

// Where the picture shows a point, counted from its middle.
Pixels onScreen(const render::Camera& camera, const render::Vec3f& point) {
  const render::Vec3f forward = (camera.target - camera.eye).normalized();
  const render::Vec3f right = forward.cross(camera.up).normalized();
  const render::Vec3f to = point - camera.eye;
  const float slope = std::tan(camera.fieldOfViewDegrees * static_cast<float>(M_PI) / 360);
  const float pixels = 360 / (slope * std::max(1e-6f, to.dot(forward)));
  return {pixels * to.dot(right), -pixels * to.dot(right.cross(forward))};
}

// A letter with digits below the line: "d₁₂" for the first and the second.
std::string named(std::string letter, std::initializer_list<size_t> indices) {
  for (const size_t index : indices) {
    for (const char digit : std::to_string(index + 1)) {
      letter += "\xE2\x82";
      letter += static_cast<char>('\x80' + (digit - '0'));
    }
  }
  return letter;
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
  void label(const Vec3& at, const Pixels& offset, const std::string& text, int characters,
             const render::Color& color) const {
    const Pixels corner(-0.27f * kLabelSize * static_cast<float>(characters), 0);
    picture.labels.push_back({at.cast<float>(), text, offset + corner, color, kLabelSize});
  }
  Pixels screen(const Vec3& from, const Vec3& to) const {
    return onScreen(picture.camera, to.cast<float>()) -
           onScreen(picture.camera, from.cast<float>());
  }
  // Beside the line from `from` to `to`, this part of the way along, to its left as seen (1) or to
  // its right (-1).
  void beside(const Vec3& from, const Vec3& to, double part, float side, const std::string& text,
              int characters, const render::Color& color) const {
    const Pixels along = screen(from, to);
    const Pixels across =
        along.norm() > 1e-3f ? Pixels(along.y(), -along.x()).normalized().eval() : Pixels(0, -1);
    label(from + part * (to - from), side * kLabelDistance * across, text, characters, color);
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
    pen.label(here, kAngleDistance * outside, named("θ", {k}), 2, kPivot);
  }
}

void drawTarget(const ArmPen& pen, const physics::ArmReport& arm) {
  const float length = pen.screen(arm.target, arm.tip).norm();
  if (length > 2) pen.arrow(arm.target, arm.tip, kError);
  if (length > kShortestNamed) pen.beside(arm.target, arm.tip, 0.5, -1, "δx", 2, kError);
  pen.dot(arm.target, kTarget, 9);
  pen.picture.labels.push_back({arm.target.cast<float>(), "target", {12, 0}, kTarget, kLabelSize});
}

void drawTips(const ArmPen& pen, const physics::ArmReport& arm) {
  for (size_t k = 0; k < arm.pivots.size(); ++k) {
    pen.arrow(arm.pivots[k], arm.tip, kTip);
    pen.beside(arm.pivots[k], arm.tip, 0.35, 1, named("s", {k}), 2, kTip);
  }
}

// d_ij for the first `pivots` of i: one or two show what i and j mean, all could not be read.
void drawCentres(const ArmPen& pen, const physics::ArmReport& arm, size_t pivots) {
  const size_t count = arm.pivots.size();
  for (size_t i = 0; i < std::min(pivots, count); ++i) {
    for (size_t j = i; j < count; ++j) {
      pen.arrow(arm.pivots[i], arm.centres[j], kMass);
      pen.beside(arm.pivots[i], arm.centres[j], 0.6, 1, named("d", {i, j}), 3, kMass);
    }
  }
  for (const Vec3& centre : arm.centres) pen.dot(centre, kMass, 7);
}

}  // namespace

void drawArms(const Simulation& simulation, const Overlays& overlays, render::Picture& picture) {
  const ArmPen pen{picture};
  const bool all = overlays.arms;
  if (!all && !overlays.armTargets && !overlays.armTips && !overlays.armCentres) return;
  for (const physics::ArmReport& arm : simulation.arms()) {
    if (all || overlays.armCentres) drawCentres(pen, arm, all ? 1 : 2);
    if (all || overlays.armTips) drawTips(pen, arm);
    if (all) nameAngles(pen, arm);
    if (all || overlays.armTargets) drawTarget(pen, arm);
    drawPivots(pen, arm);
  }
}

}  // namespace scenes
