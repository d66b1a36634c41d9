// Bodies in a row, joined end to end: a chain with or without a load, and a bridge of planks.
#pragma once

#include "physics/make/placement.h"

namespace physics {

// The last body of a chain. Without a shape of its own it is the last link, with this mass; with
// one it hangs below the last link, touching the joint.
struct ChainEnd {
  std::optional<Shape> shape;
  Matter matter;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"shape"}, d.shape);
    Matter::fields(v, d.matter);
  }
};

enum class ChainJoint { kBallSocket, kHinge };
inline std::span<const char* const> names(ChainJoint) {
  static constexpr const char* kNames[] = {"ball_socket", "hinge"};
  return kNames;
}

// Links from `from` towards `to` or along `direction`, y of each along the chain. A link is
// `shape`, or a capsule of `radius` between joints that are `length` apart (else |to - from| /
// count).
struct ChainDef {
  static constexpr const char* kWord = "chain";
  Vec3 from = Vec3::Zero();
  std::optional<Vec3> to;
  std::optional<Vec3> direction;  // neither: down
  int count = 10;
  std::optional<Shape> shape;
  double radius = 0.03;          // m
  std::optional<double> length;  // m
  Matter matter;
  std::optional<ChainEnd> end;
  bool fixedStart = true;  // to the world, at `from`
  bool fixedEnd = false;
  ChainJoint joint = ChainJoint::kBallSocket;
  Vec3 axis = Vec3::UnitZ();  // world direction, of the hinges
  Form form = Form::kVector;
  bool collide = false;  // neighbours may touch
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"from", Unit::kPoint, true}, d.from);
    v(Field{"to", Unit::kPoint}, d.to);
    v(Field{"direction", Unit::kDirection}, d.direction);
    v(Field{"count", Unit::kNone, false, 1, kMostBodies}, d.count);
    v(Field{"shape"}, d.shape);
    v(Field{"radius", Unit::kMetre, false, kMorePositive}, d.radius);
    v(Field{"length", Unit::kMetre, false, kMorePositive}, d.length);
    Matter::fields(v, d.matter);
    v(Field{"end"}, d.end);
    v(Field{"fixed_start"}, d.fixedStart);
    v(Field{"fixed_end"}, d.fixedEnd);
    v(Field{"joint"}, d.joint);
    v(Field{"axis", Unit::kDirection}, d.axis);
    v(Field{"form"}, d.form);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

// Planks on hinges between two fixed points. They hang along an arc of a circle that is `sag` below
// the straight line in the middle: without any slack the tension would know no bound.
struct BridgeDef {
  static constexpr const char* kWord = "bridge";
  Vec3 from{-2, 1, 0}, to{2, 1, 0};
  int count = 12;
  double sag = 0.2;         // m
  double thickness = 0.06;  // m
  double width = 1;         // m, across
  double gap = 0.01;        // m, between planks
  Matter matter;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"from", Unit::kPoint, true}, d.from);
    v(Field{"to", Unit::kPoint, true}, d.to);
    v(Field{"count", Unit::kNone, false, 1, kMostBodies}, d.count);
    v(Field{"sag", Unit::kMetre, false, 0}, d.sag);
    v(Field{"thickness", Unit::kMetre, false, kMorePositive}, d.thickness);
    v(Field{"width", Unit::kMetre, false, kMorePositive}, d.width);
    v(Field{"gap", Unit::kMetre, false, 0}, d.gap);
    Matter::fields(v, d.matter);
    Tuning::fields(v, d.tuning);
  }
};

std::vector<BodyId> add(World& world, const ChainDef& def);
std::vector<BodyId> add(World& world, const BridgeDef& def);

}  // namespace physics
