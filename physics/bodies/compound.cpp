// Mass properties of several shapes together, by the theorem of parallel axes.
#include "physics/bodies/compound.h"

#include <Eigen/LU>
#include <cmath>

#include "physics/bodies/hull.h"

namespace physics {
namespace {

void check(const PartDef& part) {
  require(massProperties(part.shape).volume > 0 && !std::holds_alternative<Compound>(part.shape),
          "a part of a compound needs a volume of its own: a box, sphere, capsule, cylinder or "
          "convex");
  require(std::isfinite(part.mass) && part.mass > 0, "the mass of a part must be positive");
  require(part.pose.x.allFinite() && part.pose.q.coeffs().allFinite() && part.pose.q.norm() > 1e-6,
          "the pose of a part must be finite");
}

// About `centre`, in the frame that the parts are in [kg m^2].
Mat3 inertiaAbout(std::span<const PartDef> parts, const Vec3& centre) {
  Mat3 sum = Mat3::Zero();
  for (const PartDef& part : parts) {
    const Mat3 R = part.pose.q.normalized().toRotationMatrix();
    const Vec3 own = massProperties(part.shape).inertiaPerMass, arm = part.pose.x - centre;
    sum += part.mass * (R * own.asDiagonal() * R.transpose() +
                        arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  return sum;
}

// The same axes in the order and with the signs that turn them least from the frame's.
Mat3 nearest(const Mat3& axes) {
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  Mat3 best = axes;
  double most = -1;
  for (const auto& order : kOrders) {
    Mat3 ordered;
    for (int k = 0; k < 3; ++k) ordered.col(k) = axes.col(order[k]);
    for (int k = 0; k < 3; ++k) {
      if (ordered(k, k) < 0) ordered.col(k) = -ordered.col(k);
    }
    if (ordered.determinant() < 0) {
      int least = 0;
      ordered.diagonal().minCoeff(&least);
      ordered.col(least) = -ordered.col(least);
    }
    if (ordered.trace() > most + 1e-9) most = ordered.trace(), best = ordered;
  }
  return best;
}

}  // namespace

PrincipalCompound makeCompound(std::span<const PartDef> parts, const Pose& frame,
                               const Vec3& inertiaPerMass) {
  require(!parts.empty(), "a compound needs at least one part");
  auto made = std::make_shared<Parts>();
  PrincipalCompound result;
  result.toParts = {frame.x, frame.q.normalized()};
  const Quat back = result.toParts.q.conjugate();
  for (const PartDef& part : parts) {
    check(part);
    const Pose inside{back * (part.pose.x - frame.x), (back * part.pose.q).normalized()};
    made->list.push_back({part.shape, inside});
    made->volume += massProperties(part.shape).volume;
    result.mass += part.mass;
  }
  made->inertiaPerMass = inertiaPerMass;
  result.compound.parts = std::move(made);
  return result;
}

PrincipalCompound makeCompound(std::span<const PartDef> parts) {
  double mass = 0;
  Vec3 first = Vec3::Zero();
  for (const PartDef& part : parts) {
    check(part);
    mass += part.mass;
    first += part.mass * part.pose.x;
  }
  require(mass > 0, "a compound needs at least one part");
  const Vec3 centre = first / mass;
  const Mat3 inertia = inertiaAbout(parts, centre) / mass;
  const Mat3 axes = nearest(principalAxes(inertia));
  const Vec3 moments = (axes.transpose() * inertia * axes).diagonal();
  return makeCompound(parts, {centre, Quat(axes).normalized()}, moments);
}

}  // namespace physics
