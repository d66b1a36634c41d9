// An arch of wedge-shaped stones (voussoirs) that stands by compression alone, without mortar.
#pragma once

#include "physics/make/placement.h"

namespace physics {

// In the x-y plane about the placement's origin, the middle of the ground below. The stones share
// the arch's angle evenly. Below 180 degrees, or raised by `springer_height`, it stands on two
// fixed springers.
struct ArchDef {
  static constexpr const char* kWord = "arch";
  Placement place;
  int stones = 15;                        // odd: with a keystone
  double radius = 2;                      // m, of the inner face
  double thickness = 0.4;                 // m
  double depth = 0.6;                     // m, along z
  double angle = 3.14159265358979323846;  // rad
  double springerHeight = 0;              // m
  Matter matter;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"stones", Unit::kNone, false, 2, 10000}, d.stones);
    v(Field{"radius", Unit::kMetre, false, kMorePositive}, d.radius);
    v(Field{"thickness", Unit::kMetre, false, kMorePositive}, d.thickness);
    v(Field{"depth", Unit::kMetre, false, kMorePositive}, d.depth);
    v(Field{"degrees", Unit::kDegrees, false, 10, 180}, d.angle);
    v(Field{"springer_height", Unit::kMetre, false, 0}, d.springerHeight);
    Matter::fields(v, d.matter);
  }
};

// The stones from left to right, then the springers.
std::vector<BodyId> add(World& world, const ArchDef& def);

}  // namespace physics
