// Masses of links: of their parts, summed, seen from elsewhere.
#include "scenes/models/mass.h"

#include "physics/bodies/hull.h"

namespace scenes {
namespace {

using physics::Mat3;
using physics::Vec3;

// Parallel axes: what a mass at r adds to the inertia about the origin.
Mat3 ofPoint(double mass, const Vec3& r) {
  return mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
}

}  // namespace

ModelInertial inertialOf(const ModelPart& part) {
  if (part.mass && *part.mass == 0) return {};
  const physics::MassProperties matter = physics::massProperties(part.shape);
  physics::Pose frame = part.pose;
  if (!part.points.empty()) frame = frame * physics::makeHull(part.points).toPoints;
  ModelInertial out;
  out.mass = part.mass.value_or(part.density * matter.volume);
  const Mat3 turn = frame.q.toRotationMatrix();
  out.centre = frame.x;
  out.inertia = turn * (out.mass * matter.inertiaPerMass).asDiagonal() * turn.transpose();
  return out;
}

ModelInertial moved(const ModelInertial& inertial, const physics::Pose& pose) {
  const Mat3 turn = pose.q.toRotationMatrix();
  return {inertial.mass, pose.x + turn * inertial.centre,
          turn * inertial.inertia * turn.transpose()};
}

ModelInertial sum(const ModelInertial& a, const ModelInertial& b) {
  const double mass = a.mass + b.mass;
  if (!(mass > 0)) return {0, a.centre, a.inertia + b.inertia};
  const Vec3 centre = (a.mass * a.centre + b.mass * b.centre) / mass;
  return {mass, centre,
          a.inertia + ofPoint(a.mass, a.centre - centre) + b.inertia +
              ofPoint(b.mass, b.centre - centre)};
}

ModelInertial inertialOf(const ModelLink& link) {
  if (link.inertial) return *link.inertial;
  ModelInertial total;
  for (const ModelPart& part : link.parts) total = sum(total, inertialOf(part));
  return total;
}

PrincipalInertial principal(const ModelInertial& inertial) {
  PrincipalInertial out;
  out.frame.x = inertial.centre;
  const Mat3 inertia = (inertial.inertia + inertial.inertia.transpose()) / 2;
  const Mat3 axes = physics::principalAxes(inertia);
  out.frame.q = physics::Quat(axes).normalized();
  out.moments = (axes.transpose() * inertia * axes).diagonal();
  return out;
}

}  // namespace scenes
