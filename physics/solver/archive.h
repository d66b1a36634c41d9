// A contact as the small steps keep it.
#pragma once

#include "physics/constraints/archive.h"
#include "physics/solver/kept_contact.h"

namespace physics {

inline void archive(Archive& to, KeptContact& contact) {
  auto& [a, b, key, radial, carried, count, normal, friction, step, whole, lambda, before, held,
         tangential, twist, points] = contact;
  to(a, b, key, radial, carried, count, normal, friction, step, whole, tangential, twist);
  for (auto* loads : {&lambda, &before, &held}) to.first(count, *loads);
  to.first(count, points);
}

}  // namespace physics
