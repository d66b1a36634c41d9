// Bodies outside a World, and what a solve gave them.
#include "tests/physics/pair.h"

#include <cmath>

namespace physics::testing {

BodyId add(Bodies& bodies, const BodyOf& def) {
  const Vec3 inertia = def.mass > 0 ? def.inertia : Vec3::Zero().eval();
  const Vec3 inverse = inertia.unaryExpr([](double i) { return i > 0 ? 1 / i : 0.0; });
  const Mat3 rotation = def.pose.q.toRotationMatrix();
  bodies.pose.push_back(def.pose);
  bodies.start.push_back(def.pose);
  bodies.velocity.emplace_back();
  bodies.inverse.push_back(
      {def.mass > 0 ? 1 / def.mass : 0, rotation * inverse.asDiagonal() * rotation.transpose()});
  bodies.inverseInertia.push_back(inverse);
  bodies.inertia.push_back(inertia);
  bodies.mass.push_back(def.mass);
  bodies.motion.push_back(def.mass > 0 ? Motion::kDynamic : Motion::kStatic);
  bodies.shift.push_back(Vec3::Zero());
  bodies.freeTurn.push_back(Vec3::Zero());
  bodies.shape.push_back(PointShape{});
  bodies.friction.emplace_back();
  if (def.mass > 0) bodies.active.push_back(bodies.size() - 1);
  if (inverse.x() != inverse.y() || inverse.y() != inverse.z()) {
    bodies.anisotropic.push_back(bodies.size() - 1);
  }
  return bodies.size() - 1;
}

Bodies bodiesOf(std::initializer_list<BodyOf> defs) {
  Bodies bodies;
  for (const BodyOf& def : defs) add(bodies, def);
  return bodies;
}

Bodies randomBodies(Random& random, int count) {
  Bodies bodies;
  for (int b = 0; b < count; ++b) {
    BodyOf def;
    def.mass = random.uniform(0.5, 3);
    const Vec3 squares(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
    def.inertia = def.mass * (Vec3::Constant(squares.sum()) - squares);  // of three pairs of points
    def.pose = {random.inBall(2), random.rotation(kPi)};
    add(bodies, def);
  }
  return bodies;
}

Quat about(const Vec3& axis, double angle) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

Momenta given(const Bodies& before, const Bodies& after) {
  Momenta sum;
  for (int b = 0; b < before.size(); ++b) {
    if (before.motion[b] != Motion::kDynamic) continue;
    const Vec3 push = before.mass[b] * (after.pose[b].x - before.pose[b].x);
    const Vec3 turn = logarithm(after.pose[b].q * before.pose[b].q.conjugate());
    const Mat3 rotation = before.pose[b].q.toRotationMatrix();
    const Vec3 twist = rotation * before.inertia[b].asDiagonal() * rotation.transpose() * turn;
    sum.linear += push;
    sum.angular += before.pose[b].x.cross(push) + twist;
    sum.linearScale += push.norm();
    sum.angularScale += before.pose[b].x.norm() * push.norm() + twist.norm();
  }
  return sum;
}

double angleOf(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace physics::testing
