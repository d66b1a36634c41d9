// Where what rows lead to ends, contacts that carry load touch, and do not rock. What rows lead to
// is off by what they differ by, and no row takes that back by powers of h: a contact gives way by
// h^2, so that all substeps do the same to it, however long they are. What is left of how a line of
// contact rocks the next step's rows turn round, and make more of it: a hoop that rolls would rock
// until a side lifts.
#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "physics/model/islands.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// Of what the first of them take passes leave less, so that what is taken anew in each step dies.
constexpr double kLeft = 1e-2;
constexpr int kMostPasses = 64;  // a hoop takes 14; some gaps of a face cannot close together

}  // namespace

// Both bodies, as they resist a push along the normal.
SmallSteps::Impl::PressedPoint SmallSteps::Impl::pressedPoint(const Bodies& b, int contact,
                                                              int point) const {
  const KeptContact& c = contacts[contact];
  const ContactPoint& shape = c.points[point];
  const Vec3 n = normalOf(c, b.pose);
  PressedPoint pressed{.contact = contact};
  const auto see = [&](PressedPoint::Side& side, BodyId body, double sign, const Vec3& at) {
    side = {body, isMovable(b, body), sign * n, sign * at.cross(n), {}};
    pressed.gap += side.normal.dot(b.pose[body].x + at);
    pressed.speed += side.opening(b.velocity[body].v, b.velocity[body].w);
    if (!side.moves) return;
    const JointMass& mass = masses[body];
    side.way = {mass.inverse * side.normal, mass.inertia * side.lever};
    pressed.gives += side.opening(side.way.u, side.way.theta);
  };
  see(pressed.sides[0], c.a, 1, b.pose[c.a].q * shape.coreA - shape.radiusA * n);
  see(pressed.sides[1], c.b, -1, b.pose[c.b].q * shape.coreB + shape.radiusB * n);
  return pressed;
}

// To `moved`, what takes `open` of all of them: Gauss-Seidel.
void SmallSteps::Impl::takeBack(const Batch& batch, double PressedPoint::*open) {
  for (const BodyId i : batch.bodies) moved[i] = {Vec3::Zero(), Vec3::Zero()};
  double first = 0, most = 1;
  for (int pass = 0; pass < kMostPasses && most > kLeft * first; ++pass) {
    most = 0;
    for (const PressedPoint& point : pressedPoints) {
      double left = point.*open;
      for (const PressedPoint::Side& side : point.sides) {
        if (side.moves) left += side.opening(moved[side.body].u, moved[side.body].theta);
      }
      for (const PressedPoint::Side& side : point.sides) {
        if (!side.moves) continue;
        moved[side.body].u -= left / point.gives * side.way.u;
        moved[side.body].theta -= left / point.gives * side.way.theta;
      }
      most = std::max(most, std::abs(left));
    }
    if (pass == 0) first = most;
  }
}

// Of points, one contact after the other, how they open otherwise than its mean: as it rocks. What
// they open by together is the load of the next step, and gives friction by it.
void SmallSteps::Impl::seeRocking() {
  std::vector<PressedPoint>& all = pressedPoints;
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    while (end < all.size() && all[end].contact == all[first].contact) ++end;
    Vec3 lever[2] = {Vec3::Zero(), Vec3::Zero()};
    double speed = 0;
    const double count = static_cast<double>(end - first);
    for (std::size_t k = first; k < end; ++k) {
      for (int s = 0; s < 2; ++s) lever[s] += all[k].sides[s].lever / count;
      speed += all[k].speed / count;
    }
    for (std::size_t k = first; k < end; ++k) {
      PressedPoint& point = all[k];
      point.speed -= speed;
      point.gives = 0;
      for (int s = 0; s < 2; ++s) {
        PressedPoint::Side& side = point.sides[s];
        side.normal.setZero();
        side.lever -= lever[s];
        if (!side.moves) continue;
        side.way = {Vec3::Zero(), masses[side.body].inertia * side.lever};
        point.gives += side.lever.dot(side.way.theta);
      }
    }
  }
  std::erase_if(all, [](const PressedPoint& point) { return !(point.gives > 0); });
}

// What is further off than `most` [m] is deep in each row, and comes out as that is let to.
void SmallSteps::Impl::putOnContacts(Model& w, const Batch& batch, double most) {
  Bodies& b = w.bodies;
  for (const BodyId i : batch.bodies) takeMass(w, i);
  pressedPoints.clear();
  for (const int contact : batch.contacts) {
    for (int k = 0; k < contacts[contact].count; ++k) {
      if (!(rowLoads[contact][k] > 0)) continue;
      const PressedPoint point = pressedPoint(b, contact, k);
      if (point.gives > 0 && std::abs(point.gap) <= most) pressedPoints.push_back(point);
    }
  }
  takeBack(batch, &PressedPoint::gap);
  for (const BodyId i : batch.bodies) displace(b.pose[i], moved[i].u, moved[i].theta);
  seeRocking();
  takeBack(batch, &PressedPoint::speed);
  for (const BodyId i : batch.bodies) {
    b.velocity[i].v += moved[i].u;
    b.velocity[i].w += moved[i].theta;
  }
}

}  // namespace physics
