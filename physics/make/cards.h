// Thin boxes on edge: a house of cards, a row of dominoes.
#pragma once

#include "physics/make/placement.h"

namespace physics {

// `storeys` pairs of leaning cards at the bottom, one pair fewer each storey, flat cards between.
// The leaning cards touch at their upper edges and the feet of neighbours touch; a flat card
// reaches from the top of one pair to the top of the next, and the pair above stands on it:
//      /\ .
//      ==
//    /\  /\ .
struct CardHouseDef {
  static constexpr const char* kWord = "card_house";
  Placement place;
  int storeys = 3;
  double length = 0.088;     // m, of a leaning card
  double width = 0.063;      // m, along z
  double thickness = 0.002;  // m
  double lean = 0.3;         // rad, from the vertical
  Matter matter;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"storeys", Unit::kNone, false, 1, 300}, d.storeys);
    v(Field{"length", Unit::kMetre, false, kMorePositive}, d.length);
    v(Field{"width", Unit::kMetre, false, kMorePositive}, d.width);
    v(Field{"thickness", Unit::kMetre, false, kMorePositive}, d.thickness);
    v(Field{"lean_degrees", Unit::kDegrees, false, 1, 60}, d.lean);
    Matter::fields(v, d.matter);
  }
};

// Boxes along x, or along an arc that turns by `turn_degrees` (to the left seen from above) over
// its length.
struct DominoesDef {
  static constexpr const char* kWord = "dominoes";
  Placement place;  // the foot of the first
  int count = 20;
  Vec3 size{0.008, 0.048, 0.024};  // m: thickness along the row, height, width
  double spacing = 0.024;          // m, centre to centre
  double turn = 0;                 // rad
  double push = 0;                 // rad/s: the first starts to fall forward about its front edge
  Matter matter;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"count", Unit::kNone, false, 1, kMostBodies}, d.count);
    v(Field{"size", Unit::kMetre, false, kMorePositive}, d.size);
    v(Field{"spacing", Unit::kMetre, false, kMorePositive}, d.spacing);
    v(Field{"turn_degrees", Unit::kDegrees, false, -3600, 3600}, d.turn);
    v(Field{"push", Unit::kRadianPerSecond, false, 0}, d.push);
    Matter::fields(v, d.matter);
  }
};

std::vector<BodyId> add(World& world, const CardHouseDef& def);
std::vector<BodyId> add(World& world, const DominoesDef& def);

}  // namespace physics
