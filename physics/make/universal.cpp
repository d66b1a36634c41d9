// A universal joint out of the constraints there are.
#include "physics/make/universal.h"

#include <cmath>

namespace physics {

void add(World& world, const UniversalDef& def) {
  const Vec3 a = def.directions[0].stableNormalized(), b = def.directions[1].stableNormalized();
  require(std::abs(a.dot(b)) < 1e-6,
          "a universal joint's directions must be at a right angle at the start");
  PerpendicularDef cross;
  cross.bodies = def.bodies;
  cross.directions = def.directions;
  cross.collide = def.collide;
  cross.tuning = def.tuning;
  world.add(cross);

  BallSocketDef ball;
  ball.bodies = def.bodies;
  ball.at = def.at;
  ball.collide = def.collide;
  ball.tuning = def.tuning;
  world.add(ball);
}

}  // namespace physics
