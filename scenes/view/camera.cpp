// Fitting a box into a perspective picture, and smooth motion through keys.
#include "scenes/view/camera.h"

#include <algorithm>
#include <cmath>

namespace scenes {
namespace {

using physics::Vec3;

// A camera's frame and the slopes of its picture's edges.
struct Frustum {
  Vec3 right, up, forward;
  double slopeX, slopeY;
};

Frustum frustumAlong(const Vec3& direction, double fieldOfViewDegrees, double aspect,
                     double margin) {
  Frustum f;
  f.forward = direction.normalized();
  f.right = f.forward.cross(Vec3::UnitY());
  if (f.right.norm() < 1e-6) f.right = Vec3::UnitX();  // straight down
  f.right.normalize();
  f.up = f.right.cross(f.forward);
  f.slopeY = std::tan(fieldOfViewDegrees * M_PI / 360);
  f.slopeX = f.slopeY * aspect;
  f.slopeX /= 1 + 2 * margin;
  f.slopeY /= 1 + 2 * margin;
  return f;
}

std::array<Vec3, 8> cornersOf(const MotionBounds& box) {
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[i] = Vec3(i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                      i & 4 ? box.high.z() : box.low.z());
  }
  return corners;
}

// The eye nearest to the points that still sees them all: the planes of the picture's edges, moved
// along their normals until they touch, meet in the eye's two coordinates across the view.
Vec3 eyeThatSees(const std::array<Vec3, 8>& points, const Frustum& f) {
  Vec3 eye = Vec3::Zero();
  double back = std::numeric_limits<double>::infinity();
  for (const auto& [axis, slope] : {std::pair{f.right, f.slopeX}, std::pair{f.up, f.slopeY}}) {
    double most = -std::numeric_limits<double>::infinity(), least = -most;
    for (const Vec3& p : points) {
      most = std::max(most, p.dot(axis) - slope * p.dot(f.forward));
      least = std::min(least, p.dot(axis) + slope * p.dot(f.forward));
    }
    // axis . eye = across, forward . eye = depth:  most = across - slope depth, least = across +
    // slope depth
    eye += 0.5 * (most + least) * axis;
    back = std::min(back, 0.5 * (least - most) / slope);
  }
  return eye + back * f.forward;
}

Vec3 hermite(const Vec3& a, const Vec3& b, const Vec3& slopeA, const Vec3& slopeB, double span,
             double t) {
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * span * slopeA + (3 * t2 - 2 * t3) * b +
         (t3 - t2) * span * slopeB;
}

// Velocity at key i: the mean slope to its neighbours, rest at both ends.
Vec3 slopeAt(const std::vector<CameraKey>& keys, size_t i, Vec3 CameraKey::*member) {
  if (i == 0 || i + 1 == keys.size()) return Vec3::Zero();
  return (keys[i + 1].*member - keys[i - 1].*member) / (keys[i + 1].time - keys[i - 1].time);
}

}  // namespace

render::Camera fitCamera(const CameraDef& def, const MotionBounds& box, double aspect,
                         double groundHeight) {
  const Frustum f = frustumAlong(def.direction, def.fieldOfViewDegrees, aspect, def.margin);
  Vec3 eye = eyeThatSees(cornersOf(box), f);
  const double depth = std::max(1e-30, (0.5 * (box.low + box.high) - eye).dot(f.forward));
  Vec3 target = eye + depth * f.forward;
  const double lowest = groundHeight + 0.05 * depth;
  const double lift = std::max(0.0, lowest - eye.y());
  eye.y() += lift;
  render::Camera camera;
  camera.eye = eye.cast<float>();
  camera.target = target.cast<float>();
  camera.fieldOfViewDegrees = static_cast<float>(def.fieldOfViewDegrees);
  if (std::abs(f.forward.y()) > 0.999) camera.up = {0, 0, -1};
  return camera;
}

render::Camera keyCamera(const std::vector<CameraKey>& keys, double time) {
  const auto after =
      std::find_if(keys.begin(), keys.end(), [&](const CameraKey& key) { return key.time > time; });
  const size_t b =
      after == keys.end() ? keys.size() - 1 : static_cast<size_t>(after - keys.begin());
  const size_t a = after == keys.begin() || after == keys.end() ? b : b - 1;
  const double span = keys[b].time - keys[a].time;
  const double t = span > 0 ? (time - keys[a].time) / span : 0;
  const auto at = [&](Vec3 CameraKey::*member) {
    return hermite(keys[a].*member, keys[b].*member, slopeAt(keys, a, member),
                   slopeAt(keys, b, member), span, t);
  };
  render::Camera camera;
  camera.eye = at(&CameraKey::eye).cast<float>();
  camera.target = at(&CameraKey::target).cast<float>();
  camera.fieldOfViewDegrees = static_cast<float>(
      keys[a].fieldOfViewDegrees + t * (keys[b].fieldOfViewDegrees - keys[a].fieldOfViewDegrees));
  return camera;
}

}  // namespace scenes
