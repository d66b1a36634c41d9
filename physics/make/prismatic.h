// A prismatic joint: body j slides along an axis of body i without turning. A point on a line plus
// an orientation lock, and where asked a slide limit along the same line.
#pragma once

#include "physics/world.h"

namespace physics {

struct PrismaticDef {
  static constexpr const char* kWord = "prismatic";
  std::array<BodyId, 2> bodies{};
  Vec3 at = Vec3::Zero();                       // world coordinates at the start
  Vec3 axis = Vec3::UnitX();                    // world direction at the start
  std::optional<std::array<double, 2>> limits;  // of bodies[1] along the axis [m], 0 at the start
  bool collide = false;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"at", Unit::kPoint, true}, d.at);
    v(Field{"axis", Unit::kDirection, true}, d.axis);
    v(Field{"limits", Unit::kMetre}, d.limits);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

void add(World& world, const PrismaticDef& def);

}  // namespace physics
