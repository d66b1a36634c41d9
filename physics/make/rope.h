// A rope: nodes in a row that cannot be pulled apart.
#pragma once

#include "physics/make/soft.h"

namespace physics {

// Ends of a rope that never move.
enum class RopePins { kNone, kStart, kEnd, kBoth };
inline std::span<const char* const> names(RopePins) {
  static constexpr const char* kNames[] = {"none", "start", "end", "both"};
  return kNames;
}

struct RopeAttachments {  // bodies that hold an end, at its place
  std::optional<BodyRef> start, end;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"start"}, d.start);
    v(Field{"end"}, d.end);
  }
};

// `count` nodes from `from` to `to`, or `length` along `direction`. A rope longer than its ends are
// apart hangs between them in an arc.
struct RopeDef {
  static constexpr const char* kWord = "rope";
  Vec3 from = Vec3::Zero();
  std::optional<Vec3> to;
  std::optional<Vec3> direction;
  int count = 20;                // nodes
  std::optional<double> length;  // m; absent: (1 + slack) |to - from|
  double slack = 0;              // of |to - from|
  double radius = 0.02;          // m
  SoftMatter matter;
  double compliance = 0;  // m/N, of a link
  bool totalLength = true;
  Bending bending;
  RopePins pins = RopePins::kNone;
  std::optional<RopeAttachments> attach;
  std::optional<AirDrag> drag;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"from", Unit::kPoint, true}, d.from);
    v(Field{"to", Unit::kPoint}, d.to);
    v(Field{"direction", Unit::kDirection}, d.direction);
    v(Field{"count", Unit::kNone, false, 2, kMostBodies}, d.count);
    v(Field{"length", Unit::kMetre, false, kMorePositive}, d.length);
    v(Field{"slack", Unit::kNone, false, 0}, d.slack);
    v(Field{"radius", Unit::kMetre, false, kMorePositive}, d.radius);
    SoftMatter::fields(v, d.matter);
    v(Field{"compliance", Unit::kNone, false, 0}, d.compliance);
    v(Field{"total_length"}, d.totalLength);
    Bending::fields(v, d.bending);
    v(Field{"pins"}, d.pins);
    v(Field{"attach"}, d.attach);
    v(Field{"drag"}, d.drag);
  }
};

std::vector<BodyId> add(World& world, const RopeDef& def);

}  // namespace physics
