// Orientation lock.
#include "physics/constraints/orientation_lock.h"

namespace physics {
namespace {

// 1/theta^2 - cot(theta/2)/(2 theta); below 0.02 its series, which is exact there to 1e-17.
double curvature(double theta) {
  if (theta < 0.02) {
    const double squared = theta * theta;
    return 1.0 / 12 + squared / 720 + squared * squared / 30240;
  }
  const SineCosine half = sineCosine(0.5 * theta);
  return 1 / (theta * theta) - half.cosine / (2 * theta * half.sine);
}

}  // namespace

// A turn delta of j in the world is R_i^T delta in the frame of i, on the left of d.
void OrientationLock::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Quat &i = x.now[bodies[0]].q, &j = x.now[bodies[1]].q;
  row.c = logarithm(i.conjugate() * j * reference.conjugate());
  const Mat3 cross = skew(row.c);
  const Mat3 inverseJacobian =
      Mat3::Identity() - 0.5 * cross + curvature(row.c.norm()) * (cross * cross);
  row.angular[1] = inverseJacobian * i.toRotationMatrix().transpose();
  row.angular[0] = -row.angular[1];
}

}  // namespace physics
