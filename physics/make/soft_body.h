// A soft body: a solid of tetrahedra that keep their volume, with edges that give way.
#pragma once

#include "physics/make/placement.h"
#include "physics/make/soft.h"
#include "physics/make/tet_mesh.h"

namespace physics {

struct TetBox {  // a grid of cells, five tetrahedra to each
  Vec3 size = Vec3::Ones();
  std::array<int, 3> cells{3, 3, 3};
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"size", Unit::kMetre, true, kMorePositive}, d.size);
    v(Field{"cells", Unit::kNone, true, 1, 1000}, d.cells);
  }
};

struct TetBall {
  double radius = 0.5;
  int cells = 4;  // across
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"radius", Unit::kMetre, true, kMorePositive}, d.radius);
    v(Field{"cells", Unit::kNone, false, 1, 100}, d.cells);
  }
};

// Nodes that never move: those of one side, along the body's own axes.
enum class SoftPins { kNone, kLeft, kRight, kBottom, kTop };
inline std::span<const char* const> names(SoftPins) {
  static constexpr const char* kNames[] = {"none", "left", "right", "bottom", "top"};
  return kNames;
}

// The placement is the origin of the mesh, or the middle of the box or ball.
struct SoftBodyDef {
  static constexpr const char* kWord = "soft_body";
  Placement place;
  double scale = 1;
  std::optional<TetBox> box;    // or
  std::optional<TetBall> ball;  // or
  std::optional<TetMesh> mesh;
  Vec3 startScale = Vec3::Ones();  // along the mesh's axes: it starts deformed by this,
                                   // 0: flat, below 0: inside out
  SoftMatter matter;
  double radius = 0.01;  // m, of the skin
  EdgeMatter edge{Edges::kSprings, 0, false, 1000, 1};
  bool volume = true;
  std::optional<double> bulkModulus;  // Pa; absent: volumes are kept
  SoftPins pins = SoftPins::kNone;
  Velocity velocity;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"scale", Unit::kNone, false, kMorePositive}, d.scale);
    v(Field{"start_scale"}, d.startScale);
    v(Field{"box"}, d.box);
    v(Field{"ball"}, d.ball);
    v(Field{"mesh"}, d.mesh);
    SoftMatter::fields(v, d.matter);
    v(Field{"radius", Unit::kMetre, false, kMorePositive}, d.radius);
    EdgeMatter::fields(v, d.edge);
    v(Field{"volume"}, d.volume);
    v(Field{"bulk_modulus", Unit::kNone, false, kMorePositive}, d.bulkModulus);
    v(Field{"pins"}, d.pins);
    v(Field{"velocity"}, d.velocity.v);
  }
};

// The triangles are the skin; every node is in the parts.
SoftParts add(World& world, const SoftBodyDef& def);

}  // namespace physics
