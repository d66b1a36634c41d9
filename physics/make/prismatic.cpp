// A prismatic joint out of the constraints there are.
#include "physics/make/prismatic.h"

namespace physics {

void add(World& world, const PrismaticDef& def) {
  PointOnLineDef line;
  line.bodies = def.bodies;
  line.at = def.at;
  line.axis = def.axis;
  line.collide = def.collide;
  line.tuning = def.tuning;
  world.add(line);

  OrientationLockDef lock;
  lock.bodies = def.bodies;
  lock.collide = def.collide;
  lock.tuning = def.tuning;
  world.add(lock);

  if (def.limits) {
    SlideLimitDef limit;
    limit.bodies = def.bodies;
    limit.at = def.at;
    limit.axis = def.axis;
    limit.range = *def.limits;
    limit.tuning = def.tuning;
    world.add(limit);
  }
}

}  // namespace physics
