// The pictures that the renderer's tests and benchmarks draw.
#include "sample.h"

#include <cmath>

namespace render {
namespace {

const Color kBlue(0.36f, 0.55f, 0.78f, 1), kOrange(0.90f, 0.60f, 0.25f, 1);
const Color kTeal(0.30f, 0.65f, 0.60f, 1), kSand(0.87f, 0.80f, 0.64f, 1);
const Color kRed(0.80f, 0.30f, 0.25f, 1);

Instance body(Primitive primitive, const Vec3f& size, const Vec3f& position, const Color& color) {
  Instance instance;
  instance.primitive = primitive;
  instance.size = size;
  instance.position = position;
  instance.color = color;
  return instance;
}

Eigen::Quaternionf about(const Vec3f& axis, float angle) {
  return Eigen::Quaternionf(Eigen::AngleAxisf(angle, axis.normalized()));
}

void addPyramid(Picture& picture, int base, float side, const Vec3f& corner) {
  for (int row = 0; row < base; ++row)
    for (int i = 0; i < base - row; ++i) {
      const auto x = static_cast<float>(i) + 0.5f * static_cast<float>(row);
      const Vec3f at = corner + side * Vec3f(x, static_cast<float>(row) + 0.5f, 0);
      picture.instances.push_back(
          body(Primitive::kBox, Vec3f::Constant(side), at, (row + i) % 3 == 0 ? kSand : kBlue));
    }
}

}  // namespace

Picture pyramidPicture(int base) {
  Picture picture;
  const auto width = static_cast<float>(base);
  addPyramid(picture, base, 1, {-width / 2 + 0.5f, 0, 0});
  picture.camera.eye = {0.55f * width, 0.6f * width, 1.6f * width};
  picture.camera.target = {0, 0.38f * width, 0};
  picture.focusCenter = {0, 0.4f * width, 0};
  picture.focusRadius = 0.7f * width;
  return picture;
}

Picture ragdollPicture(int count) {
  Picture picture;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<float>(i);
    Instance limb = body(Primitive::kCapsule, {0.16f, 0.4f, 0.16f},
                         {0.5f * std::fmod(k, 5.0f) - 1, 0.2f + 0.25f * std::fmod(k, 3.0f),
                          0.4f * std::floor(k / 5) - 0.8f},
                         i % 2 == 0 ? kOrange : kTeal);
    limb.orientation = about({0.3f, 0.2f, 1}, 0.7f * k);
    picture.instances.push_back(limb);
  }
  picture.camera.eye = {2.4f, 2.0f, 3.6f};
  picture.camera.target = {0, 0.4f, 0};
  picture.ground.spacing = 0.25f;
  picture.focusCenter = {0, 0.4f, 0};
  picture.focusRadius = 1.8f;
  return picture;
}

namespace {

Surface wavingSheet(int nodes) {
  Surface sheet;
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * nodes + i); };
  for (int j = 0; j < nodes; ++j)
    for (int i = 0; i < nodes; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(nodes - 1);
      const float v = static_cast<float>(j) / static_cast<float>(nodes - 1);
      const float lift = 0.18f * std::sin(9 * u + 3 * v) * (0.3f + v);
      sheet.positions.push_back({2.4f * u - 1.6f, 2.6f - 2.2f * v, lift - 0.3f});
      sheet.grid.push_back({20 * u, 20 * v});
      if (i == 0 || j == 0) continue;
      const std::uint32_t a = index(i - 1, j - 1), b = index(i, j - 1), c = index(i, j);
      for (const std::uint32_t k : {a, c, b, a, index(i - 1, j), c}) sheet.indices.push_back(k);
    }
  sheet.color = kBlue;
  sheet.backColor = kOrange;
  return sheet;
}

Surface octahedron(const Vec3f& center, float radius) {
  Surface skin;
  for (const Vec3f& axis : {Vec3f::UnitX().eval(), Vec3f::UnitY().eval(), Vec3f::UnitZ().eval()})
    for (const float side : {radius, -radius}) skin.positions.push_back(center + side * axis);
  skin.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  skin.edges = true;
  skin.color = skin.backColor = kTeal;
  return skin;
}

}  // namespace

Picture clothPicture(int nodes) {
  Picture picture;
  picture.surfaces = {wavingSheet(nodes), octahedron({1.5f, 0.6f, 0.4f}, 0.6f)};
  picture.instances = {body(Primitive::kSphere, Vec3f::Ones(), {-0.4f, 0.5f, 0.9f}, kSand)};
  picture.camera.eye = {1.2f, 2.4f, 6};
  picture.camera.target = {0, 1.2f, 0};
  picture.ground.spacing = 0.5f;
  picture.focusCenter = {0, 1.2f, 0};
  picture.focusRadius = 2.4f;
  return picture;
}

Picture samplePicture() {
  Picture picture;
  addPyramid(picture, 6, 0.5f, {-2.6f, 0, -0.6f});
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<float>(i);
    Instance ball = body(Primitive::kSphere, Vec3f::Constant(0.7f), {-1.9f + 1.1f * k, 0.35f, 1.0f},
                         i == 1 ? kTeal : kOrange);
    ball.marked = true;
    ball.orientation = about({1, 0.4f * k, 0.2f}, 0.5f + k);
    picture.instances.push_back(ball);
  }
  Instance drum = body(Primitive::kCylinder, {0.6f, 0.8f, 0.6f}, {1.35f, 0.4f, -0.5f}, kSand);
  picture.instances.push_back(drum);
  drum.position = {2.1f, 0.3f, 0.3f};
  drum.orientation = about({1, 0, 0.6f}, 1.5707963f);
  drum.marked = true;
  picture.instances.push_back(drum);
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<float>(i);
    Instance link = body(Primitive::kCapsule, {0.18f, 0.4f, 0.18f},
                         {1.2f + 0.32f * k, 1.9f - 0.22f * k, 0.2f}, i % 2 == 0 ? kTeal : kOrange);
    link.orientation = about({0, 0, 1}, 0.96f);
    picture.instances.push_back(link);
  }
  Instance glass = body(Primitive::kBox, {0.8f, 0.8f, 0.8f}, {1.2f, 0.4f, 1.3f}, kBlue);
  glass.color.w() = 0.4f;
  glass.orientation = about({0, 1, 0}, 0.4f);
  picture.instances.push_back(glass);
  picture.lines.push_back({{1.0f, 2.0f, 0.2f}, {1.0f, 2.9f, 0.2f}, kRed, 3, true, true});
  picture.lines.push_back(
      {{-2.6f, 0.02f, 0.2f}, {2.6f, 0.02f, 0.2f}, {0, 0, 0, 1}, 2, false, false});
  picture.lines.push_back(
      {{0.4f, 1.6f, 0}, {2.4f, 0.9f, 0.2f}, {0.1f, 0.1f, 0.4f, 1}, 1, false, true});
  picture.dots.push_back({{1.0f, 2.0f, 0.2f}, kRed, 9});
  picture.labels.push_back(
      {{1.0f, 2.9f, 0.2f}, "λ₁ → 12.5 N·m", {10, -6}, {0.1f, 0.1f, 0.1f, 1}, 18});
  picture.labels.push_back(
      {{-1.35f, 3.0f, -0.6f}, "x² + y² ≤ µ²·n², α ≈ 30°", {8, -8}, {0.1f, 0.1f, 0.1f, 1}, 18});
  picture.caption = "Figure 1. Pyramid, balls and a chain × 4";
  picture.camera.eye = {2.6f, 2.6f, 7.2f};
  picture.camera.target = {0, 1.0f, 0};
  picture.ground.spacing = 0.5f;
  picture.focusCenter = {0, 0.8f, 0.2f};
  picture.focusRadius = 3.4f;
  return picture;
}

Hud sampleHud(int frames) {
  Hud hud;
  hud.visible = true;
  hud.title = "Pyramid, 21 boxes";
  hud.rows = {{"time", "1.50 s"}, {"substeps × iterations", "4 × 8"}, {"contacts", "84"}};
  Plot energy{"energy", "J", {{"kinetic", {}, kBlue}, {"potential", {}, kOrange}}, 240, false};
  Plot error{"joint error", "m", {{"ball socket", {}, kTeal}}, 240, true};
  for (int i = 0; i < frames; ++i) {
    const auto t = static_cast<float>(i) / 60;
    energy.curves[0].values.push_back(20 * t * std::exp(-t));
    energy.curves[1].values.push_back(12 * std::exp(-t) + 3);
    error.curves[0].values.push_back(std::exp(-5 * t) * (1.2f + std::sin(9 * t)));
  }
  hud.plots = {energy, error};
  return hud;
}

}  // namespace render
