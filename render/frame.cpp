// Camera, light and ground of a picture as the numbers that the shaders read.
#include "render/frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace render {
namespace {

void requireFinite(bool finite, const std::string& what) {
  if (!finite) throw std::invalid_argument("picture: a number that is not finite in " + what);
}

void checkInstances(const Picture& picture) {
  for (std::size_t i = 0; i < picture.instances.size(); ++i) {
    const Instance& instance = picture.instances[i];
    requireFinite(instance.position.allFinite() && instance.size.allFinite() &&
                      instance.orientation.coeffs().allFinite() && instance.color.allFinite(),
                  "instance " + std::to_string(i));
    if (instance.primitive == Primitive::kMesh && !instance.mesh)
      throw std::invalid_argument("picture: instance " + std::to_string(i) + " has no mesh");
  }
}

bool allFinite(const std::vector<Vec3f>& points) {
  return std::all_of(points.begin(), points.end(), [](const Vec3f& p) { return p.allFinite(); });
}

void checkSurfaces(const Picture& picture) {
  for (std::size_t i = 0; i < picture.surfaces.size(); ++i) {
    const Surface& s = picture.surfaces[i];
    const std::string name = "surface " + std::to_string(i);
    requireFinite(allFinite(s.positions) && s.color.allFinite() && s.backColor.allFinite() &&
                      std::isfinite(s.offset),
                  name);
    if (s.indices.size() % 3 != 0 || (!s.grid.empty() && s.grid.size() != s.positions.size()))
      throw std::invalid_argument(
          "picture: " + name + ": three indices per triangle and a grid for all positions or none");
    for (const std::uint32_t index : s.indices)
      if (index >= s.positions.size())
        throw std::invalid_argument("picture: " + name + ": index " + std::to_string(index) +
                                    " of " + std::to_string(s.positions.size()) + " positions");
  }
}

void checkCamera(const Picture& picture) {
  const Camera& camera = picture.camera;
  requireFinite(camera.eye.allFinite() && camera.target.allFinite() && camera.up.allFinite(),
                "the camera");
  requireFinite(picture.focusCenter.allFinite() && std::isfinite(picture.focusRadius), "the focus");
  requireFinite(picture.light.direction.allFinite() && picture.light.color.allFinite() &&
                    std::isfinite(picture.light.softness),
                "the light");
  requireFinite(std::isfinite(picture.ground.height) && std::isfinite(picture.ground.spacing),
                "the ground");
  if (camera.eye == camera.target) throw std::invalid_argument("camera: eye and target coincide");
  if (!(camera.fieldOfViewDegrees > 0 && camera.fieldOfViewDegrees < 170))
    throw std::invalid_argument("camera: field of view must lie in (0, 170) degrees, got " +
                                std::to_string(camera.fieldOfViewDegrees));
  if (picture.light.direction.norm() == 0 || picture.focusRadius <= 0)
    throw std::invalid_argument("picture: light direction and focus radius must not be zero");
}

// Any unit vector normal to unit n, steered by `hint` where that is possible.
Vec3f normalTo(const Vec3f& n, const Vec3f& hint) {
  const Vec3f side = n.cross(hint);
  if (side.norm() > 1e-4f * hint.norm()) return side.normalized();
  return n.cross(std::abs(n.x()) < 0.7f ? Vec3f::UnitX().eval() : Vec3f::UnitZ().eval())
      .normalized();
}

void setCamera(Frame& frame, const Picture& picture) {
  const Camera& camera = picture.camera;
  frame.eye = camera.eye;
  frame.ahead = (camera.target - camera.eye).normalized();
  frame.right = normalTo(frame.ahead, camera.up);
  frame.up = frame.right.cross(frame.ahead);
  frame.pixelsPerMetre =
      static_cast<float>(frame.height) /
      (2 * std::tan(camera.fieldOfViewDegrees * std::numbers::pi_v<float> / 360));
}

Ball ballOf(const Surface& surface) {
  Vec3f low = surface.positions[0], high = low;
  for (const Vec3f& p : surface.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {0.5f * (low + high), 0.5f * (high - low).norm() + std::abs(surface.offset)};
}

std::vector<Ball> ballsOf(const Picture& picture) {
  std::vector<Ball> balls;
  for (const Instance& instance : picture.instances)
    balls.push_back({instance.position, radiusOf(instance)});
  for (const Surface& surface : picture.surfaces)
    if (!surface.positions.empty()) balls.push_back(ballOf(surface));
  return balls;
}

// Near and far planes just around what is there, so that depth stays precise.
void setProjection(Frame& frame, const Picture& picture) {
  float nearest = frame.depthOf(picture.focusCenter) - picture.focusRadius;
  float farthest = frame.depthOf(picture.focusCenter) + picture.focusRadius;
  for (const Ball& ball : frame.balls) {
    const float depth = frame.depthOf(ball.center);
    nearest = std::min(nearest, depth - ball.radius);
    farthest = std::max(farthest, depth + ball.radius);
  }
  farthest = std::max(farthest, 1e-30f) * 1.01f;
  frame.nearest = std::max(nearest * 0.99f, farthest * 2e-4f);
  const float n = frame.nearest, f = farthest;
  const float h = 2 * frame.pixelsPerMetre / static_cast<float>(frame.height);
  const float aspect = static_cast<float>(frame.width) / static_cast<float>(frame.height);
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity(), projection = Eigen::Matrix4f::Zero();
  view.block<1, 3>(0, 0) = frame.right.transpose();
  view.block<1, 3>(1, 0) = frame.up.transpose();
  view.block<1, 3>(2, 0) = -frame.ahead.transpose();
  view.block<3, 1>(0, 3) = -(view.block<3, 3>(0, 0) * frame.eye);
  projection(0, 0) = h / aspect;
  projection(1, 1) = h;
  projection(2, 2) = -(f + n) / (f - n);
  projection(2, 3) = -2 * f * n / (f - n);
  projection(3, 2) = -1;
  frame.block.toClip = projection * view;
}

// A light's view of the sphere in focus, orthographic: along `along`, whose sides are orthonormal.
struct LightView {
  Vec3f along, side, up;
  float radius = 0;

  LightView(const Vec3f& direction, const Picture& picture)
      : along(direction.normalized()),
        side(normalTo(along, Vec3f::UnitY())),
        up(side.cross(along)),
        radius(picture.focusRadius * 1.05f) {}

  // To [0,1] in each direction. Casters in front of the sphere are clamped to its near side.
  Eigen::Matrix4f matrix(const Vec3f& center) const {
    Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
    m.block<1, 3>(0, 0) = side.transpose() / (2 * radius);
    m.block<1, 3>(1, 0) = up.transpose() / (2 * radius);
    m.block<1, 3>(2, 0) = along.transpose() / (2 * radius);
    m.block<3, 1>(0, 3) = Vec3f::Constant(0.5f) - m.block<3, 3>(0, 0) * center;
    return m;
  }
};

void setShadow(Frame& frame, const Picture& picture, const Detail& detail) {
  const LightView light(picture.light.direction, picture);
  const float radius = light.radius;
  const float texel = 2 * radius / static_cast<float>(detail.shadowSize);
  frame.texelsPerMetre = 1 / texel;
  frame.block.toShadow = light.matrix(picture.focusCenter);
  frame.block.towardLight.head<3>() = -light.along;
  frame.block.towardLight.w() = 0;
  frame.block.shadow << (picture.light.shadows ? 1.0f : 0.0f), 1.2f * texel,
      1.4f / static_cast<float>(detail.shadowSize), static_cast<float>(detail.shadowTaps);
  // y = height on the ray of (u, v): the inverse of m has the orthogonal rows of m as columns.
  const Vec3f perMap = 2 * radius * Vec3f(light.side.y(), light.up.y(), light.along.y());
  const float middle = picture.focusCenter.y() - 0.5f * perMap.sum();
  const float steep = std::min(perMap.z(), -1e-3f * radius);
  constexpr float kSoftening = 3;  // of the ground's masks, for a light of the usual softness
  frame.block.shadowOfGround << -perMap.x() / steep, -perMap.y() / steep,
      (picture.ground.height - middle) / steep,
      kSoftening * picture.light.softness / Light().softness;
  frame.block.keyColor << 0.61f * picture.light.color.x(), 0.60f * picture.light.color.y(),
      0.58f * picture.light.color.z(), 0;
}

void setGround(Frame& frame, const Picture& picture) {
  const Ground& ground = picture.ground;
  const Vec3f toFocus = picture.focusCenter - frame.eye;
  const float distance = std::hypot(toFocus.x(), toFocus.z());
  frame.groundDrawn = ground.visible && frame.eye.y() > ground.height;
  const float begin = 1.5f * picture.focusRadius + 0.5f * distance;
  const float scale = frame.scale;
  frame.block.ground << ground.height, (frame.groundDrawn ? 1.0f : 0.0f),
      std::max(ground.spacing, 1e-30f), 0.55f * std::max(scale, 0.75f);
  frame.block.groundFade << picture.focusCenter.x(), picture.focusCenter.z(), begin, 3.2f * begin;
  frame.block.groundColor = ground.color;
}

}  // namespace

Detail detailOf(Quality quality) {
  switch (quality) {
    case Quality::kDraft:
      return {1, 1024, 1, 0};
    case Quality::kPaper:
      return {1, 1024, 1, 16};
    case Quality::kStandard:
      break;
  }
  return {4, 1024, 2, 0};
}

float radiusOf(const Instance& instance) {
  const Vec3f size = instance.size.cwiseAbs();
  switch (instance.primitive) {
    case Primitive::kSphere:
      return size.maxCoeff() / 2;
    case Primitive::kCapsule:
      return (size.x() + size.y()) / 2;
    case Primitive::kMesh: {
      float squared = 0;
      for (const Vec3f& p : instance.mesh->positions)
        squared = std::max(squared, p.cwiseProduct(size).squaredNorm());
      return std::sqrt(squared);
    }
    case Primitive::kBox:
    case Primitive::kCylinder:
      break;
  }
  return size.norm() / 2;
}

Frame frameOf(const Picture& picture, const RendererOptions& options, const Detail& detail) {
  checkCamera(picture);
  checkInstances(picture);
  checkSurfaces(picture);
  Frame frame;
  frame.balls = ballsOf(picture);
  frame.width = options.width;
  frame.height = options.height;
  frame.scale = static_cast<float>(frame.height) / 720.0f;
  setCamera(frame, picture);
  setProjection(frame, picture);
  setShadow(frame, picture, detail);
  setGround(frame, picture);
  frame.block.eye = frame.eye.homogeneous();
  frame.block.background = picture.background;
  frame.block.pixels << static_cast<float>(frame.width), static_cast<float>(frame.height),
      std::max(0.9f * frame.scale, 0.6f), picture.focusRadius;
  return frame;
}

Frame exposed(Frame frame, const Picture& picture, const Detail& detail, const Exposure& exposure) {
  FrameBlock& block = frame.block;
  const Eigen::RowVector4f depth = block.toClip.row(3);
  block.toClip.row(0) += 2 * exposure.aside.x() / static_cast<float>(frame.width) * depth;
  block.toClip.row(1) += 2 * exposure.aside.y() / static_cast<float>(frame.height) * depth;
  const LightView middle(picture.light.direction, picture);
  const Eigen::Vector2f off = picture.light.softness * exposure.onLight;
  Picture lit;
  lit.light = picture.light;
  lit.light.direction = middle.along + off.x() * middle.side + off.y() * middle.up;
  lit.ground = picture.ground;
  lit.focusCenter = picture.focusCenter;
  lit.focusRadius = picture.focusRadius;
  setShadow(frame, lit, detail);
  block.toLights[0] = block.toShadow;
  for (std::size_t k = 0; k < kSkies; ++k) {
    block.towardSky[k] << exposure.sky[k], 0;
    block.toLights[1 + k] = LightView(-exposure.sky[k], picture).matrix(picture.focusCenter);
  }
  return frame;
}

}  // namespace render
