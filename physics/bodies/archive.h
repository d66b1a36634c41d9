// What steps change of bodies. Structured bindings name every member: another one does not compile
// until it is decided whether the next step reads it.
#pragma once

#include "physics/base/archive.h"
#include "physics/bodies/body.h"

namespace physics {

inline void archive(Archive& a, Friction& friction) {
  auto& [staticCoefficient, dynamicCoefficient] = friction;
  a(staticCoefficient, dynamicCoefficient);
}

inline void archive(Archive& a, InverseMass& inverse) {
  auto& [m, inertia] = inverse;
  a(m, inertia);
}

inline void archive(Archive& a, DeltaX& change) {
  auto& [dx, dtheta] = change;
  a(dx, dtheta);
}

inline void archive(Archive& a, History& history) {
  auto& [dx, dtheta, velocity, angularMomentum, smooth] = history;
  a(dx, dtheta, velocity, angularMomentum, smooth);
}

// `middle` is scratch.
inline void archive(Archive& a, SecondOrder& second) {
  auto& [scheme, step, history, origin, before, middle, velocity, angularMomentum, target, twist,
         jointTwist, kick, h] = second;
  a(scheme, step, history, origin, before, velocity, angularMomentum, target, twist, jointTwist,
    kick, h);
  middle.resize(scheme.size());
}

// Masses, shapes and materials are those that the bodies were added with; who steps follows from
// who sleeps.
inline void archive(Archive& a, Bodies& bodies) {
  auto& [pose, start, velocity, inverse, inverseInertia, inertia, mass, motion, shift, freeTurn,
         shape, friction, restitution, mostRestitution, general, isSoft, active, anisotropic,
         second] = bodies;
  a(pose, start, velocity, inverse, shift, freeTurn, second);
}

}  // namespace physics
