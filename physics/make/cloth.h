// A cloth: a grid of nodes with links along its rows and columns.
//
//     [0,0]--[1,0]--[2,0]   row 0     u: along a row
//       |      |      |               v: down a column
//     [0,1]--[1,1]--[2,1]             the front looks along v x u
#pragma once

#include "physics/make/soft.h"

namespace physics {

enum class ClothPins { kNone, kTwoCorners, kFourCorners, kTopRow };  // corners of row 0 are the two
inline std::span<const char* const> names(ClothPins) {
  static constexpr const char* kNames[] = {"none", "two_corners", "four_corners", "top_row"};
  return kNames;
}

struct ClothAttachment {  // a node that a body holds
  GridIndex node;
  BodyRef body;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"node", Unit::kNone, true, 0}, d.node);
    v(Field{"body", Unit::kNone, true}, d.body);
  }
};

// The placement is the middle of the sheet. `scatter`: nodes that nothing holds start anywhere
// within this distance of their places; what joins them is as long as without it. Node [i, j] has
// index j * nodes[0] + i.
struct ClothDef {
  static constexpr const char* kWord = "cloth";
  Vec3 position = Vec3::Zero();
  Vec3 u = Vec3::UnitX(), v = Vec3::UnitZ();
  Vec2 size = Vec2::Ones();  // m, along u and v
  GridIndex nodes{20, 20};
  double radius = 0.01;  // m, half the thickness
  double scatter = 0;    // m
  unsigned seed = 1;
  SoftMatter matter;
  EdgeMatter edge;
  bool shear = false;          // both diagonals of every cell as well
  double shearCompliance = 0;  // m/N
  bool totalLength = true;     // of every row and every column
  Bending bending;
  ClothPins pins = ClothPins::kNone;
  std::vector<GridIndex> pinned;  // besides
  std::vector<ClothAttachment> attach;
  std::optional<AirDrag> drag;
  template <class V, class D>
  static void fields(V& visit, D& d) {
    visit(Field{"position", Unit::kPoint}, d.position);
    visit(Field{"u", Unit::kDirection}, d.u);
    visit(Field{"v", Unit::kDirection}, d.v);
    visit(Field{"size", Unit::kMetre, true, kMorePositive}, d.size);
    visit(Field{"nodes", Unit::kNone, true, 2, kMostBodies}, d.nodes);
    visit(Field{"radius", Unit::kMetre, false, kMorePositive}, d.radius);
    visit(Field{"scatter", Unit::kMetre, false, 0}, d.scatter);
    visit(Field{"seed"}, d.seed);
    SoftMatter::fields(visit, d.matter);
    EdgeMatter::fields(visit, d.edge);
    visit(Field{"shear"}, d.shear);
    visit(Field{"shear_compliance", Unit::kNone, false, 0}, d.shearCompliance);
    visit(Field{"total_length"}, d.totalLength);
    Bending::fields(visit, d.bending);
    visit(Field{"attach"}, d.attach);
    visit(Field{"drag"}, d.drag);
  }
};

SoftParts add(World& world, const ClothDef& def);

}  // namespace physics
