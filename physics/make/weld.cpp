// A weld out of the constraints there are.
#include "physics/make/weld.h"

namespace physics {

void add(World& world, const WeldDef& def) {
  BallSocketDef point;
  point.bodies = def.bodies;
  const auto& pose = world.bodies().pose;
  point.at = def.at.value_or(0.5 * (pose[def.bodies[0]].x + pose[def.bodies[1]].x));
  point.collide = def.collide;
  point.tuning = def.tuning;
  world.add(point);

  OrientationLockDef lock;
  lock.bodies = def.bodies;
  lock.collide = def.collide;
  lock.tuning = def.tuning;
  world.add(lock);
}

}  // namespace physics
