// Energy, momenta and the state hash.
#include "physics/world/measure.h"

#include <xxhash.h>

#include "physics/motion/second_order.h"

namespace physics {

Measures measure(const World& world) {
  const Bodies& b = world.bodies();
  Measures m;
  for (int i = 0; i < b.size(); ++i) {
    if (b.motion[i] != Motion::kDynamic) continue;
    const Velocity& velocity = b.velocity[i];
    const Vec3 spin = angularMomentum(b, i, velocity.w);
    m.kinetic += 0.5 * b.mass[i] * velocity.v.squaredNorm() + 0.5 * velocity.w.dot(spin);
    m.linearMomentum += b.mass[i] * velocity.v;
    m.angularMomentum += b.mass[i] * b.pose[i].x.cross(velocity.v) + spin;
    if (world.settings().gravity)
      m.potential -= b.mass[i] * b.pose[i].x.dot(*world.settings().gravity);
  }
  m.potential += world.springEnergy();
  return m;
}

std::uint64_t stateHash(const World& world) {
  const Bodies& b = world.bodies();
  XXH64_state_t* state = XXH64_createState();
  XXH64_reset(state, 0);
  const auto feed = [&](const double* values, int count) {
    XXH64_update(state, values, sizeof(double) * static_cast<std::size_t>(count));
  };
  for (int i = 0; i < b.size(); ++i) {
    feed(b.pose[i].x.data(), 3);
    feed(b.pose[i].q.coeffs().data(), 4);
    feed(b.velocity[i].v.data(), 3);
    feed(b.velocity[i].w.data(), 3);
  }
  for (BodyId i = 0; i < b.size(); ++i) {
    if (world.isAsleep(i)) XXH64_update(state, &i, sizeof i);
  }
  const std::int64_t steps = world.stepCount();
  XXH64_update(state, &steps, sizeof steps);
  const std::uint64_t hash = XXH64_digest(state);
  XXH64_freeState(state);
  return hash;
}

}  // namespace physics
