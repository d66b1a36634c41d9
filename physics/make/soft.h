// What ropes, cloths and soft bodies share: nodes without rotation, what they weigh, and where they
// hang.
#pragma once

#include "physics/make/matter.h"

namespace physics {

struct BodyRef {  // a body by its name
  BodyId id = kWorldBody;
};
struct GridIndex {  // of a node, or a count of nodes in both directions
  int i = 0, j = 0;
};

// Mass of the whole, of each node, or density; and friction.
struct SoftMatter {
  std::optional<double> mass;      // kg
  std::optional<double> nodeMass;  // kg
  std::optional<double> density;   // kg/m^3; none of them: 1000 kg/m^3
  std::optional<Friction> friction;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"mass", Unit::kNone, false, kMorePositive}, d.mass);
    v(Field{"node_mass", Unit::kNone, false, kMorePositive}, d.nodeMass);
    v(Field{"density", Unit::kNone, false, kMorePositive}, d.density);
    v(Field{"friction"}, d.friction);
  }
};

// Resistance of three nodes in a row to leaving their line.
struct Bending {
  double stiffness = 0;  // N/m on x0 - 2 x1 + x2; 0: none
  double damping = 0;    // N s/m
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bending_stiffness", Unit::kNewtonPerMetre, false, 0}, d.stiffness);
    v(Field{"bending_damping", Unit::kNewtonSecondPerMetre, false, 0}, d.damping);
  }
};

struct AirDrag {
  double coefficient = 0;
  Vec3 wind = Vec3::Zero();  // m/s
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"coefficient", Unit::kNone, true, 0}, d.coefficient);
    v(Field{"wind"}, d.wind);
  }
};

// How edges hold their length.
enum class Edges { kLinks, kSprings, kNone };
inline std::span<const char* const> names(Edges) {
  static constexpr const char* kNames[] = {"links", "springs", "none"};
  return kNames;
}
struct EdgeMatter {
  Edges edges = Edges::kLinks;
  double compliance = 0;     // m/N, of links; 0: rigid
  bool stretchOnly = false;  // links give way where they are pressed together
  double stiffness = 1000;   // N/m, of springs
  double damping = 0;        // N s/m, of springs
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"edges"}, d.edges);
    v(Field{"compliance", Unit::kNone, false, 0}, d.compliance);
    v(Field{"stretch_only"}, d.stretchOnly);
    v(Field{"stiffness", Unit::kNewtonPerMetre, false, 0}, d.stiffness);
    v(Field{"damping", Unit::kNewtonSecondPerMetre, false, 0}, d.damping);
  }
};

// Nodes that were added, and the triangles between them that are seen, as indices of nodes.
struct SoftParts {
  std::vector<BodyId> nodes;
  std::vector<std::array<int, 3>> triangles;
};

// kg of a node where all weigh the same; `volume` [m^3] is that of the whole.
double nodeMassOf(const SoftMatter& matter, double volume, int count);

// A point; it never moves where it is `fixed`.
BodyId addNode(World& world, const Vec3& at, double mass, bool fixed, const SoftMatter& matter);

// A link or a spring, unless neither end can move; without a length it is as at the start.
void addEdge(World& world, BodyId a, BodyId b, const EdgeMatter& matter,
             std::optional<double> length = {});

// True where one of the bodies can move.
bool anyMoves(const World& world, std::span<const BodyId> bodies);

// Bending over every three consecutive bodies.
void addBending(World& world, std::span<const BodyId> row, const Bending& bending);

// Holds a node at its place on a body, which its links do not touch there.
void attach(World& world, BodyId node, BodyId body);

}  // namespace physics
