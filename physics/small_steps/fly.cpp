// Bodies that nothing holds: exactly, in one go.
#include "physics/motion/free_motion.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
// Bodies that nothing holds.
void SmallSteps::Impl::fly(Model& w, double dt) {
  Bodies& b = w.bodies;
  for (const BodyId i : free) {
    Velocity& v = b.velocity[i];
    b.start[i] = b.pose[i];
    Vec3 gain = Vec3::Zero();
    if (b.motion[i] == Motion::kDynamic) {
      if (w.settings.gravity) gain = dt * *w.settings.gravity;
      gain += dt * b.inverse[i].m * w.loads[i].force;
    }
    b.pose[i].x += dt * (v.v + 0.5 * gain);
    v.v += gain;
    if (b.inverseInertia[i].isZero(0) || isIsotropic(b.inertia[i])) {
      v.w += dt * b.inverseInertia[i].x() * w.loads[i].torque;
      if (!v.w.isZero(0)) b.pose[i].q = (exponential(dt * v.w) * b.pose[i].q).normalized();
      continue;
    }
    const Mat3 r = b.pose[i].q.toRotationMatrix();
    Vec3 omega = r.transpose() * v.w;
    omega += dt * b.inverseInertia[i].cwiseProduct(r.transpose() * w.loads[i].torque);
    const FreeTurn turn = freeTurn(b.inertia[i], omega, dt);
    const Vec3 theta = dt * (r * turn.mean);
    v.w = exponential(theta) * (r * turn.after);
    b.pose[i].q = (exponential(theta) * b.pose[i].q).normalized();
  }
}

}  // namespace physics
