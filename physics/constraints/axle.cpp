// Axle, (80)-(87).
#include "physics/constraints/axle.h"

namespace physics {

// In the frame (u, v, n_j) of body j let m = n_i, s = |(m_u, m_v)|, phi = atan2(s, m_n), f = phi/s.
// Then n_i x n_j = (m_v, -m_u, 0) and c = f (m_v, -m_u). A relative rotation d (of i against j)
// moves m by d x m, and phi by -w.d; f moves by (dphi - f ds)/s with ds = (m_u dm_u + m_v dm_v)/s.
void Axle::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Mat3 frame = x.now[bodies[1]].q.toRotationMatrix() * frameJ;  // columns u, v, n_j
  const Vec3 m = frame.transpose() * (x.now[bodies[0]].q * axisI);
  const double s2 = m.x() * m.x() + m.y() * m.y(), s = std::sqrt(s2);
  const double phi = arcTangent(s, m.z());
  Eigen::Matrix<double, 2, 3> gradient;  // dc/dd in the frame's components
  if (s > 1e-7) {
    const double f = phi / s;
    row.c << f * m.y(), -f * m.x();
    const Vec3 w(m.y() / s, -m.x() / s, 0);
    const Vec3 dmu(0, m.z(), -m.y()), dmv(-m.z(), 0, m.x());  // rows of d x m by d
    const Vec3 ds = (m.x() * dmu + m.y() * dmv) / s;
    const Vec3 df = (-w - f * ds) / s;
    gradient.row(0) = f * dmv + m.y() * df;
    gradient.row(1) = -f * dmu - m.x() * df;
  } else {
    row.c << (m.z() < 0 ? kPi : m.y()), (m.z() < 0 ? 0 : -m.x());  // antiparallel: w = u
    gradient << -1, 0, 0, 0, -1, 0;
  }
  row.angular[0] = gradient * frame.transpose();
  row.angular[1] = -row.angular[0];
}

}  // namespace physics
