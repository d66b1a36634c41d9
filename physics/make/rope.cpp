// Nodes along a line or a hanging arc, links between neighbours, and what holds the ends.
#include "physics/make/rope.h"

#include <cmath>
#include <numbers>

#include "physics/base/rotation.h"

namespace physics {
namespace {

struct Span {
  Vec3 along;   // unit, from the first node to the last
  double ends;  // m between them
  double length;
};

Span spanOf(const RopeDef& def) {
  require(def.to || def.direction, "expected 'to' or 'direction'");
  if (!def.to) {
    require(def.length.has_value(), "expected 'length' or 'to', which it follows from");
    return {def.direction->normalized(), *def.length, *def.length};
  }
  const double ends = (*def.to - def.from).norm();
  const double length = def.length.value_or((1 + def.slack) * ends);
  require(length > 0, "expected 'to' away from 'from', or a length");
  require(length >= ends * (1 - 1e-9),
          "expected a length of at least |to - from| = " + std::to_string(ends) + " m, got " +
              std::to_string(length) + " m");
  const Vec3 along = ends > 1e-9 * length ? ((*def.to - def.from) / ends).eval() : Vec3::UnitX();
  return {along, ends, length};
}

// Half the angle of the arc of which `links` equal chords reach from end to end:
//   sin(a) / sin(a / links) = ends / link, which falls from `links` at 0 to nothing at pi.
double halfAngle(double endsOverLink, int links) {
  double low = 0, high = std::numbers::pi;
  for (int i = 0; i < 60; ++i) {
    const double a = 0.5 * (low + high);
    (sineCosine(a).sine > endsOverLink * sineCosine(a / links).sine ? low : high) = a;
  }
  return 0.5 * (low + high);
}

std::vector<Vec3> placesOf(const RopeDef& def) {
  const Span span = spanOf(def);
  const int links = def.count - 1;
  const double link = span.length / links;
  std::vector<Vec3> places;
  if (span.length <= span.ends * (1 + 1e-9)) {
    for (int i = 0; i <= links; ++i) places.push_back(def.from + i * link * span.along);
    return places;
  }
  const Vec3 down = -Vec3::UnitY() + span.along.y() * span.along;
  const Vec3 sag = down.norm() > 1e-6 ? down.normalized() : Vec3::UnitX();
  const double a = halfAngle(span.ends / link, links);
  const double radius = 0.5 * link / sineCosine(a / links).sine;
  const Vec3 middle = def.from + 0.5 * span.ends * span.along;
  for (int i = 0; i <= links; ++i) {
    const auto [sine, cosine] = sineCosine(a * (2.0 * i / links - 1));
    places.push_back(middle + radius * sine * span.along +
                     radius * (cosine - sineCosine(a).cosine) * sag);
  }
  return places;
}

// An end that is pinned, or attached to what never moves.
bool isFixed(const World& world, bool pinned, const std::optional<BodyRef>& held) {
  require(!pinned || !held, "expected an end in 'pins' or in 'attach', not in both");
  return pinned || (held && world.bodies().motion[held->id] == Motion::kStatic);
}

void addLength(World& world, const RopeDef& def, const std::vector<BodyId>& nodes) {
  EdgeMatter edge;
  edge.stretchOnly = true;
  edge.compliance = def.compliance;
  for (std::size_t i = 1; i < nodes.size(); ++i) addEdge(world, nodes[i - 1], nodes[i], edge);
  if (!def.totalLength || nodes.size() < 3) return;
  RopeLengthDef total;
  total.bodies = nodes;
  world.add(total);
}

void addAir(World& world, const AirDrag& air, const std::vector<BodyId>& nodes) {
  for (const BodyId node : nodes) {
    if (world.bodies().motion[node] != Motion::kDynamic) continue;
    DragDef drag;
    drag.bodies = {node};
    drag.coefficient = air.coefficient;
    drag.wind = air.wind;
    world.add(drag);
  }
}

void touch(World& world, const RopeDef& def, const std::vector<BodyId>& nodes) {
  SoftSurfaceDef surface;
  surface.nodes = nodes;
  for (std::size_t i = 1; i < nodes.size(); ++i) surface.links.push_back({nodes[i - 1], nodes[i]});
  surface.radius = def.radius;
  surface.friction = world.bodies().friction[nodes[0]];
  world.add(surface);
}

}  // namespace

std::vector<BodyId> add(World& world, const RopeDef& def) {
  require(def.count >= 2, "expected at least 2 nodes");
  const std::vector<Vec3> places = placesOf(def);
  const double length = def.count > 1 ? (places[1] - places[0]).norm() * (def.count - 1) : 0;
  const double volume = std::numbers::pi * def.radius * def.radius * length;
  const double mass = nodeMassOf(def.matter, volume, def.count);
  const RopeAttachments held = def.attach.value_or(RopeAttachments{});
  const bool start =
      isFixed(world, def.pins == RopePins::kStart || def.pins == RopePins::kBoth, held.start);
  const bool end =
      isFixed(world, def.pins == RopePins::kEnd || def.pins == RopePins::kBoth, held.end);
  std::vector<BodyId> nodes;
  for (int i = 0; i < def.count; ++i) {
    const bool fixed = (i == 0 && start) || (i == def.count - 1 && end);
    nodes.push_back(addNode(world, places[i], mass, fixed, def.matter));
  }
  addLength(world, def, nodes);
  addBending(world, nodes, def.bending);
  if (def.drag) addAir(world, *def.drag, nodes);
  if (held.start) attach(world, nodes.front(), held.start->id);
  if (held.end) attach(world, nodes.back(), held.end->id);
  touch(world, def, nodes);
  return nodes;
}

}  // namespace physics
