// A velocity for many bodies that move as one at the start.
#include "scenes/read/whole_velocity.h"

namespace scenes {

using physics::BodyId;
using physics::Field;
using physics::Vec3;

void WholeVelocity::read(TableReader& reader) {
  reader(Field{"velocity"}, v);
  reader(Field{"angular_velocity"}, w);
}

void WholeVelocity::give(physics::World& world, std::span<const BodyId> bodies) const {
  if (!v && !w) return;
  const physics::Bodies& b = world.bodies();
  double mass = 0;
  Vec3 first = Vec3::Zero();
  for (const BodyId i : bodies) {
    mass += b.mass[i];
    first += b.mass[i] * b.pose[i].x;
  }
  if (!(mass > 0)) return;  // all are fixed
  const Vec3 turn = w.value_or(Vec3::Zero());
  for (const BodyId i : bodies) {
    if (b.motion[i] != physics::Motion::kDynamic) continue;
    physics::Velocity velocity = b.velocity[i];
    velocity.v += v.value_or(Vec3::Zero()) + turn.cross(b.pose[i].x - first / mass);
    velocity.w += turn;
    world.setVelocity(i, velocity);
  }
}

}  // namespace scenes
