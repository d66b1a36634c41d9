// Motor.
#include "physics/constraints/motor.h"

namespace physics {

void Motor::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Vec3 n = x.now[bodies[0]].q * axisI;
  row.c[0] = n.dot(turnSince(x, bodies)) - factor.now * speed * x.dt;
  row.angular[0] = -n.transpose();
  row.angular[1] = n.transpose();
  row.high = maxTorque * x.dt * x.dt;
  row.low = -row.high;
}

}  // namespace physics
