// Piles of bodies that stand by themselves: a stack, a pyramid, a wall, a lattice.
// Each begins at its placement's origin, the middle of what it stands on, and all touch without
// overlap.
#pragma once

#include "physics/make/placement.h"

namespace physics {

// One on top of the other.
struct StackDef {
  static constexpr const char* kWord = "stack";
  Placement place;
  int count = 10;
  Shape shape = Box{};
  Matter matter;
  double gap = 0;     // m, between neighbours
  double jitter = 0;  // m, largest sideways shift of each
  unsigned seed = 1;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"count", Unit::kNone, false, 1, kMostBodies}, d.count);
    v(Field{"shape"}, d.shape);
    Matter::fields(v, d.matter);
    v(Field{"gap", Unit::kMetre, false, 0}, d.gap);
    v(Field{"jitter", Unit::kMetre, false, 0}, d.jitter);
    v(Field{"seed"}, d.seed);
  }
};

// Rows of base, base - 1, ... 1 boxes along x.
struct PyramidDef {
  static constexpr const char* kWord = "pyramid";
  Placement place;
  int base = 20;
  Vec3 size = Vec3::Ones();
  Matter matter;
  double gap = 0;  // m, between neighbours of a row
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"base", Unit::kNone, false, 1, kMostBodies}, d.base);
    v(Field{"size", Unit::kMetre, false, kMorePositive}, d.size);
    Matter::fields(v, d.matter);
    v(Field{"gap", Unit::kMetre, false, 0}, d.gap);
  }
};

// Bricks along x in running bond: every second row is shifted by half a brick, with halves at its
// ends.
struct WallDef {
  static constexpr const char* kWord = "wall";
  Placement place;
  int columns = 8, rows = 8;
  Vec3 size{0.5, 0.25, 0.25};  // m, of a brick
  Matter matter;
  double gap = 0;  // m, between neighbours of a row
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"columns", Unit::kNone, false, 1, kMostBodies}, d.columns);
    v(Field{"rows", Unit::kNone, false, 1, kMostBodies}, d.rows);
    v(Field{"size", Unit::kMetre, false, kMorePositive}, d.size);
    Matter::fields(v, d.matter);
    v(Field{"gap", Unit::kMetre, false, 0}, d.gap);
  }
};

// Copies of one or several shapes in turn on a lattice; the placement is the middle of its lowest
// layer of centres. Without `spacing` the largest shape's neighbours just touch. `joined`: a ball
// and socket half way between each and its neighbours along x, y and z.
struct GridDef {
  static constexpr const char* kWord = "grid";
  Placement place;
  Lattice lattice;
  std::vector<Shape> shapes{Box{}};
  Matter matter;
  Velocity velocity;
  bool joined = false;
  unsigned seed = 1;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    Lattice::fields(v, d.lattice);
    v(Field{"shapes", Unit::kNone, true}, d.shapes);
    Matter::fields(v, d.matter);
    v(Field{"velocity"}, d.velocity.v);
    v(Field{"angular_velocity"}, d.velocity.w);
    v(Field{"joined"}, d.joined);
    v(Field{"seed"}, d.seed);
  }
};

std::vector<BodyId> add(World& world, const StackDef& def);
std::vector<BodyId> add(World& world, const PyramidDef& def);
std::vector<BodyId> add(World& world, const WallDef& def);
std::vector<BodyId> add(World& world, const GridDef& def);

}  // namespace physics
