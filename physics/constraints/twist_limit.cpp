// Twist limit.
#include "physics/constraints/twist_limit.h"

namespace physics {
namespace {

Quat relative(const TwistLimit& limit, const Configuration& x) {
  return x.now[limit.bodies[0]].q.conjugate() * x.now[limit.bodies[1]].q *
         limit.reference.conjugate();
}

}  // namespace

double TwistLimit::twist(const Configuration& x) const {
  const Quat d = relative(*this, x);
  const double angle = 2 * arcTangent(d.vec().dot(axisI), d.w());
  return angle > kPi ? angle - 2 * kPi : angle <= -kPi ? angle + 2 * kPi : angle;
}

// With d = q_i^-1 q_j ref^-1, a = d.vec . n, w = d.w: tau = 2 atan2(a, w). A rotation delta of j
// against i, in the frame of i, moves d by 1/2 (0, delta) d: dw = -1/2 delta . v, da = 1/2 n . (w
// delta + delta x v), dtau = 2 (w da - a dw)/(w^2 + a^2) = delta . [w (w n + v x n) + a v] / (w^2 +
// a^2).
void TwistLimit::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Quat d = relative(*this, x);
  const Vec3 v = d.vec();
  const double w = d.w(), a = v.dot(axisI), squared = w * w + a * a;
  const double tau = twist(x);
  const Vec3 inI =
      squared > 1e-12 ? Vec3((w * (w * axisI + v.cross(axisI)) + a * v) / squared) : axisI;
  const Vec3 gradient = x.now[bodies[0]].q * inI;
  row.angular[0] = -gradient.transpose();
  row.angular[1] = gradient.transpose();
  const bool nearHigh = tau - low > high - tau;
  row.c[0] = nearHigh ? tau - high : tau - low;
  (nearHigh ? row.high : row.low) = 0;
}

}  // namespace physics
