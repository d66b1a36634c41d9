// What constraints and contacts carry from step to step.
#pragma once

#include "physics/bodies/archive.h"
#include "physics/collision/archive.h"
#include "physics/constraints/contact.h"
#include "physics/constraints/kinds.h"
#include "physics/constraints/soft_contact.h"

namespace physics {

inline void archive(Archive& a, ContactPointState& point) {
  auto& [shape, anchorA, anchorB, frictionTotal, normalTotal, gapAtStart, approach, normal, loaded,
         sticking] = point;
  a(shape, anchorA, anchorB, frictionTotal, normalTotal, gapAtStart, approach, normal, loaded,
    sticking);
}

inline void archive(Archive& to, ContactPair& pair) {
  auto& [a, b, key, radial, carried, normal, friction, frictional, step, count, points] = pair;
  to(a, b, key, radial, carried, normal, friction, frictional, step, count);
  to.first(count, points);
}

inline void archive(Archive& a, SoftContact& contact) {
  auto& [element, from, to, body, along, radius, onBody, normal, anchor, startSlip, friction,
         gapAtStart, normalTotal, step, frictionTotal] = contact;
  a(element, from, to, body, along, radius, onBody, normal, anchor, startSlip, friction, gapAtStart,
    normalTotal, step, frictionTotal);
}

template <int kRows>
void archive(Archive& a, Totals<kRows>& multipliers) {
  auto& [total, loaded, step] = multipliers;
  a(total, loaded, step);
}

// Of what constraints are only a drive's target changes. Who is solved follows from who sleeps.
inline void archive(Archive& a, Kinds& kinds) {
  forEachKind(kinds, [&](auto& kind) {
    a.expect(kind.set.items.size(), std::decay_t<decltype(kind)>::kWord);
    a(kind.set.lambda);
  });
  for (Drive& drive : std::get<Kind<DriveDef, Drive>>(kinds).set.items) a(drive.target);
}

}  // namespace physics
