// A universal joint (Cardan, Hooke): ball and socket plus one row, so that an axis of body i and an
// axis of body j stay at a right angle. Turns about the third direction go from one to the other.
#pragma once

#include "physics/world.h"

namespace physics {

struct UniversalDef {
  static constexpr const char* kWord = "universal";
  std::array<BodyId, 2> bodies{};
  Vec3 at = Vec3::Zero();  // world coordinates at the start
  std::array<Vec3, 2> directions{Vec3::UnitX(),
                                 Vec3::UnitY()};  // world, at the start; one fixed in each body
  bool collide = false;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"at", Unit::kPoint, true}, d.at);
    v(Field{"directions", Unit::kDirection, true}, d.directions);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

void add(World& world, const UniversalDef& def);

}  // namespace physics
