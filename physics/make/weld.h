// A weld: two bodies move as one, and the force and torque between them can be told.
#pragma once

#include "physics/make/matter.h"

namespace physics {

struct WeldDef {
  static constexpr const char* kWord = "weld";
  std::array<BodyId, 2> bodies{};
  std::optional<Vec3> at;  // world coordinates at the start; absent: midway between the centres
  bool collide = false;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"at", Unit::kPoint}, d.at);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

void add(World& world, const WeldDef& def);

}  // namespace physics
