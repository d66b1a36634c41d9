// Conservative advancement: a step ahead never exceeds the distance over the closing speed.
#include "physics/collision/sweep.h"

#include <algorithm>
#include <cmath>

#include "physics/collision/narrow.h"

namespace physics::collision {
namespace {

constexpr int kMaxAdvances = 64;  // what then still closes in counts as a touch

// Highest turning rate of `along` [rad per step]: the interpolated quaternion is fastest half way.
double turningRate(const Way& way) {
  const double sign = way.start.q.dot(way.end.q) < 0 ? -1 : 1;
  const auto from = way.start.q.coeffs(), to = way.end.q.coeffs();
  return 4 * (to - sign * from).norm() / (to + sign * from).norm();
}

}  // namespace

Pose along(const Way& way, double part) {
  const double sign = way.start.q.dot(way.end.q) < 0 ? -1 : 1;
  Pose pose;
  pose.x = way.start.x + part * (way.end.x - way.start.x);
  pose.q.coeffs() = (1 - part) * way.start.q.coeffs() + part * sign * way.end.q.coeffs();
  pose.q.normalize();
  return pose;
}

std::optional<double> firstTouch(const Solid& a, const Way& wayA, const Solid& b, const Way& wayB,
                                 double near, int& calls) {
  const Vec3 move = (wayA.end.x - wayA.start.x) - (wayB.end.x - wayB.start.x);
  const double turning = turningRate(wayA) * a.coreRadius + turningRate(wayB) * b.coreRadius;
  double part = 0;
  for (int i = 0; i < kMaxAdvances; ++i) {
    const Pose poseA = along(wayA, part), poseB = along(wayB, part);
    const Apart now = apart(a, b, relativePose(poseA, poseB));
    ++calls;
    if (now.distance <= near) return part;
    const double closing = turning - move.dot(poseB.q * now.n);
    if (part >= 1 || closing <= 0) return std::nullopt;
    // To half of `near`: the next look finds it within, though `closing` is a bound.
    part = std::min(1.0, part + (now.distance - 0.5 * near) / closing);
  }
  return part;  // still closing in: as good as a touch
}

}  // namespace physics::collision
