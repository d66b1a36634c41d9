// Motor torque.
#include "physics/constraints/motor_torque.h"

#include <cmath>

#include "physics/constraints/motor.h"

namespace physics {

// The free speed is one in the torque's own direction.
void MotorTorque::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  const Vec3 n = x.now[bodies[0]].q * axisI;
  const double stall = factor.now * stallTorque;
  const double fall = std::abs(stall) / freeSpeed * x.dt;
  push.active = stall != 0;
  push.c[0] = n.dot(turnSince(x, bodies));
  push.f[0] = stall * x.dt * x.dt - fall * push.c[0];
  push.k(0, 0) = fall;
  push.angular[0] = -n.transpose();
  push.angular[1] = n.transpose();
}

}  // namespace physics
