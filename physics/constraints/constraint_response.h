// What a change of a constraint's multiplier does to its bodies: M^-1 J^T, A = J M^-1 J^T, and the
// displacement (50),(59).
#pragma once

#include "physics/base/rotation.h"
#include "physics/constraints/constraint.h"

namespace physics {

// A = J M^-1 J^T, and M^-1 J^T in `response`.
template <int B, int R>
Eigen::Matrix<double, R, R> respond(const RowShape<B, R>& shape, const Gradients<B, R>& row,
                                    std::span<const InverseMass> masses,
                                    ResponseOf<B, R>& response) {
  Eigen::Matrix<double, R, R> a;
  a.setZero();
  if constexpr (B == kMany) {
    response.linear.resize(shape.bodies.size());
    response.angular.resize(shape.bodies.size());
  }
  for (std::size_t b = 0; b < shape.bodies.size(); ++b) {
    const auto& [inverse, inertia] = masses[shape.bodies[b]];
    if (shape.isLinear) {
      response.linear[b] = inverse * row.linear[b].transpose();
      a.noalias() += row.linear[b].lazyProduct(response.linear[b]);
    }
    if (shape.isAngular) {
      response.angular[b].noalias() = inertia.lazyProduct(row.angular[b].transpose());
      a.noalias() += row.angular[b].lazyProduct(response.angular[b]);
    }
  }
  return a;
}

template <class C>
MatrixOf<C> effectiveMassInverse(const C& item, const Gradients<C::kBodies, C::kRows>& row,
                                 std::span<const InverseMass> masses, Response<C>& response) {
  return respond(shapeOf(item), row, masses, response);
}

// Displaces one body by the change `delta` of a multiplier.
template <int B, int R>
DeltaX displacementOf(const RowShape<B, R>& shape, const ResponseOf<B, R>& response, std::size_t b,
                      const Eigen::Matrix<double, R, 1>& delta) {
  DeltaX moved;
  if (shape.isLinear) moved.dx = response.linear[b].lazyProduct(delta);
  if (shape.isAngular) moved.dtheta = response.angular[b].lazyProduct(delta);
  return moved;
}

template <int B, int R>
void displaceBodies(const RowShape<B, R>& shape, const ResponseOf<B, R>& response,
                    const Eigen::Matrix<double, R, 1>& delta, Bodies& bodies) {
  if (delta.isZero(0)) return;
  for (std::size_t b = 0; b < shape.bodies.size(); ++b) {
    const BodyId id = shape.bodies[b];
    const DeltaX moved = displacementOf(shape, response, b, delta);
    if (shape.isLinear) bodies.shift[id] += moved.dx;
    if (shape.isAngular) {
      displace(bodies.pose[id], moved.dx, moved.dtheta);
    } else {
      bodies.pose[id].x += moved.dx;
    }
  }
}

// The same, added up by body.
template <int B, int R>
void give(const RowShape<B, R>& shape, const ResponseOf<B, R>& response,
          const Eigen::Matrix<double, R, 1>& delta, std::span<DeltaX> moved) {
  for (std::size_t b = 0; b < shape.bodies.size(); ++b) {
    const DeltaX step = displacementOf(shape, response, b, delta);
    moved[shape.bodies[b]].dx += step.dx;
    moved[shape.bodies[b]].dtheta += step.dtheta;
  }
}

// The first of a constraint's bodies that can move; the world where none can. Joined bodies share
// scheme and step, and this one tells them.
inline BodyId moverOf(std::span<const BodyId> joined, const Bodies& bodies) {
  for (const BodyId body : joined) {
    if (bodies.motion[body] != Motion::kStatic) return body;
  }
  return kWorldBody;
}
template <class C>
BodyId moverOf(const C& item, const Bodies& bodies) {
  return moverOf(std::span<const BodyId>(item.bodies), bodies);
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
template <int B, int R>
void countTwist(const RowShape<B, R>& shape, const Gradients<B, R>& row,
                const Eigen::Matrix<double, R, 1>& delta, Bodies& bodies) {
  if (bodies.second.empty() || !shape.isAngular) return;
  for (std::size_t b = 0; b < shape.bodies.size(); ++b) {
    bodies.second.twist[shape.bodies[b]] += row.angular[b].transpose() * delta;
  }
}

// J dX.
template <int B, int R>
Eigen::Matrix<double, R, 1> along(const RowShape<B, R>& shape, const Gradients<B, R>& row,
                                  std::span<const DeltaX> displaced) {
  Eigen::Matrix<double, R, 1> sum = Eigen::Matrix<double, R, 1>::Zero();
  for (std::size_t b = 0; b < shape.bodies.size(); ++b) {
    const DeltaX& moved = displaced[shape.bodies[b]];
    if (shape.isLinear) sum += row.linear[b].lazyProduct(moved.dx);
    if (shape.isAngular) sum += row.angular[b].lazyProduct(moved.dtheta);
  }
  return sum;
}

}  // namespace physics
