// The geometry that constraints between two points share: p_i - p_j and its gradient. (60)-(62)
#pragma once

#include "physics/constraints/constraint.h"

namespace physics {

inline Vec3 between(std::span<const Pose> pose, const std::array<BodyId, 2>& bodies,
                    const std::array<Vec3, 2>& anchors) {
  const Pose &i = pose[bodies[0]], &j = pose[bodies[1]];
  return (i.x + i.q * anchors[0]) - (j.x + j.q * anchors[1]);
}

// Below this a distance has no direction that could be told from rounding.
constexpr double kCoincident = 1e-12;  // m

// The direction of two points that coincide now, from where they were.
inline Vec3 startDirection(const Vec3& dp) {
  const double distance = dp.norm();
  return distance > kCoincident ? Vec3(dp / distance) : Vec3::UnitY();
}

// d|dp|/dX along the unit vector d, (62).
inline void gradientAlong(const Vec3& d, std::span<const Pose> pose,
                          const std::array<BodyId, 2>& bodies, const std::array<Vec3, 2>& anchors,
                          Gradients<2, 1>& row) {
  row.linear[0] = d.transpose();
  row.linear[1] = -d.transpose();
  row.angular[0] = (pose[bodies[0]].q * anchors[0]).cross(d).transpose();
  row.angular[1] = -(pose[bodies[1]].q * anchors[1]).cross(d).transpose();
}

// d dp/dX, (72).
inline void gradientOfGap(std::span<const Pose> pose, const std::array<BodyId, 2>& bodies,
                          const std::array<Vec3, 2>& anchors, Gradients<2, 3>& row) {
  row.linear[0].setIdentity();
  row.linear[1] = -Mat3::Identity();
  row.angular[0] = -skew(pose[bodies[0]].q * anchors[0]);
  row.angular[1] = skew(pose[bodies[1]].q * anchors[1]);
}

}  // namespace physics
