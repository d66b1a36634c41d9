// A hinge out of the constraints there are.
#include "physics/make/hinge.h"

namespace physics {

void add(World& world, const HingeDef& def) {
  BallSocketDef ball;
  ball.bodies = def.bodies;
  ball.at = def.at;
  ball.form = def.form;
  ball.collide = def.collide;
  ball.tuning = def.tuning;
  world.add(ball);

  AxleDef axle;
  axle.bodies = def.bodies;
  axle.axis = def.axis;
  axle.form = def.form;
  axle.collide = def.collide;
  axle.tuning = def.tuning;
  world.add(axle);

  if (def.limits) {
    TwistLimitDef limit;
    limit.bodies = def.bodies;
    limit.axis = def.axis;
    limit.range = *def.limits;
    limit.tuning = def.tuning;
    world.add(limit);
  }
  if (def.motor) {
    MotorDef motor;
    motor.bodies = def.bodies;
    motor.axis = def.axis;
    motor.speed = def.motor->speed;
    motor.maxTorque = def.motor->maxTorque;
    motor.overTime = def.motor->overTime;
    motor.tuning = def.tuning;
    world.add(motor);
  }
}

}  // namespace physics
