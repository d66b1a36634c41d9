// What a change of a constraint's multiplier does to its bodies: M^-1 J^T, A = J M^-1 J^T, and the
// displacement (50),(59).
#pragma once

#include "physics/base/rotation.h"
#include "physics/constraints/constraint.h"

namespace physics {

// A = J M^-1 J^T, and M^-1 J^T in `response`. massOf(body) is any struct of the inverse mass and
// the inverse inertia in the world.
template <class C, class F>
Eigen::Matrix<double, C::kRows, C::kRows> respond(const C& item, const Evaluated<C>& row,
                                                  Response<C>& response, F&& massOf) {
  Eigen::Matrix<double, C::kRows, C::kRows> a;
  a.setZero();
  if constexpr (C::kBodies == kMany) {
    response.linear.resize(item.bodies.size());
    response.angular.resize(item.bodies.size());
  }
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const auto& [inverse, inertia] = massOf(item.bodies[b]);
    if (hasLinear(item)) {
      response.linear[b] = inverse * row.linear[b].transpose();
      a.noalias() += row.linear[b].lazyProduct(response.linear[b]);
    }
    if (hasAngular(item)) {
      response.angular[b].noalias() = inertia.lazyProduct(row.angular[b].transpose());
      a.noalias() += row.angular[b].lazyProduct(response.angular[b]);
    }
  }
  return a;
}

template <class C>
Eigen::Matrix<double, C::kRows, C::kRows> effectiveMassInverse(const C& item,
                                                               const Evaluated<C>& row,
                                                               std::span<const InverseMass> inverse,
                                                               Response<C>& response) {
  const auto massOf = [&](BodyId body) -> const InverseMass& { return inverse[body]; };
  return respond(item, row, response, massOf);
}

// Displaces one body by the change `delta` of a multiplier.
template <class C>
DeltaX displacementOf(const C& item, const Response<C>& response, std::size_t b,
                      const VectorOf<C>& delta) {
  DeltaX moved;
  if (hasLinear(item)) moved.dx = response.linear[b].lazyProduct(delta);
  if (hasAngular(item)) moved.dtheta = response.angular[b].lazyProduct(delta);
  return moved;
}

template <class C>
void displaceBodies(const C& item, const Response<C>& response, const VectorOf<C>& delta,
                    Bodies& bodies) {
  if (delta.isZero(0)) return;
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const BodyId id = item.bodies[b];
    const DeltaX moved = displacementOf(item, response, b, delta);
    if (hasLinear(item)) bodies.shift[id] += moved.dx;
    if (hasAngular(item)) {
      displace(bodies.pose[id], moved.dx, moved.dtheta);
    } else {
      bodies.pose[id].x += moved.dx;
    }
  }
}

// The first of a constraint's bodies that can move; the world where none can. Joined bodies share
// scheme and step, and this one tells them.
template <class C>
BodyId moverOf(const C& item, const Bodies& bodies) {
  for (const BodyId body : item.bodies) {
    if (bodies.motion[body] != Motion::kStatic) return body;
  }
  return kWorldBody;
}

// The step of the bodies that a constraint joins [s].
template <class C>
double stepOf(const C& item, const Bodies& bodies, double dt) {
  const BodyId mover = bodies.second.empty() ? kWorldBody : moverOf(item, bodies);
  return mover == kWorldBody ? dt : bodies.second.step[mover];
}

template <class C>
bool isSymmetric(const C& item, const Bodies& bodies) {
  const BodyId mover = bodies.second.empty() ? kWorldBody : moverOf(item, bodies);
  return mover != kWorldBody && bodies.second.scheme[mover] == Scheme::kSymmetric;
}

template <class C>
Configuration configurationOf(const C& item, const Bodies& bodies, double dt) {
  if (bodies.second.empty()) return {bodies.pose, bodies.start, dt};
  return {bodies.pose, bodies.start, stepOf(item, bodies, dt), bodies.second.origin,
          bodies.second.before};
}

// Keeps the account of the angular impulses that the second-order steppings balance.
template <class C>
void countTwist(const C& item, const Evaluated<C>& row, const VectorOf<C>& delta, Bodies& bodies) {
  if (bodies.second.empty() || !hasAngular(item)) return;
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    bodies.second.twist[item.bodies[b]] += row.angular[b].transpose() * delta;
  }
}

// J dX.
template <class C>
VectorOf<C> along(const C& item, const Evaluated<C>& row, std::span<const DeltaX> displaced) {
  VectorOf<C> sum = VectorOf<C>::Zero();
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const DeltaX& moved = displaced[item.bodies[b]];
    if (hasLinear(item)) sum += row.linear[b].lazyProduct(moved.dx);
    if (hasAngular(item)) sum += row.angular[b].lazyProduct(moved.dtheta);
  }
  return sum;
}

}  // namespace physics
