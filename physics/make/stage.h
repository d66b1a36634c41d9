// Fixed surroundings out of boxes: a bowl or open box, a flight of stairs.
#pragma once

#include "physics/make/placement.h"

namespace physics {

// A floor with `sides` walls. `slope_degrees` is a wall's angle from the horizontal: 90 and 4 sides
// make an open box. The placement is the middle of the floor's lower face.
struct BowlDef {
  static constexpr const char* kWord = "bowl";
  Placement place;
  int sides = 12;
  double radius = 1;       // m, from the middle to each wall at the floor
  double height = 1;       // m, of the walls above the floor
  double slope = 1;        // rad
  double thickness = 0.1;  // m
  std::optional<Friction> friction;
  std::optional<double> restitution;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"sides", Unit::kNone, false, 3, 1000}, d.sides);
    v(Field{"radius", Unit::kMetre, false, kMorePositive}, d.radius);
    v(Field{"height", Unit::kMetre, false, kMorePositive}, d.height);
    v(Field{"slope_degrees", Unit::kDegrees, false, 5, 90}, d.slope);
    v(Field{"thickness", Unit::kMetre, false, kMorePositive}, d.thickness);
    v(Field{"friction"}, d.friction);
    v(Field{"restitution", Unit::kNone, false, 0, 1}, d.restitution);
  }
};

// Steps that go down along x, each a block that stands on the ground. The placement is on the
// ground, below the far edge of the highest step.
struct StairsDef {
  static constexpr const char* kWord = "stairs";
  Placement place;
  int count = 10;
  double rise = 0.18, tread = 0.28, width = 2;  // m
  double landing = 1;                           // m, tread of the highest step
  std::optional<Friction> friction;
  std::optional<double> restitution;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"count", Unit::kNone, false, 1, kMostBodies}, d.count);
    v(Field{"rise", Unit::kMetre, false, kMorePositive}, d.rise);
    v(Field{"tread", Unit::kMetre, false, kMorePositive}, d.tread);
    v(Field{"width", Unit::kMetre, false, kMorePositive}, d.width);
    v(Field{"landing", Unit::kMetre, false, kMorePositive}, d.landing);
    v(Field{"friction"}, d.friction);
    v(Field{"restitution", Unit::kNone, false, 0, 1}, d.restitution);
  }
};

std::vector<BodyId> add(World& world, const BowlDef& def);
std::vector<BodyId> add(World& world, const StairsDef& def);

}  // namespace physics
