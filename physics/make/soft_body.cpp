// Nodes that weigh what their tetrahedra do, edges, volumes and a skin that touches.
#include "physics/make/soft_body.h"

#include <algorithm>
#include <cmath>

#include "physics/make/tet_fill.h"

namespace physics {
namespace {

TetMesh formOf(const SoftBodyDef& def) {
  require(def.box.has_value() + def.ball.has_value() + def.mesh.has_value() == 1,
          "expected one of 'box', 'ball' and 'mesh'");
  if (def.mesh) return *def.mesh;
  if (def.ball) {
    requireCount(std::pow(def.ball->cells + 1.0, 3));
    return ballMesh(def.ball->radius, def.ball->cells);
  }
  const auto& [x, y, z] = def.box->cells;
  requireCount((x + 1.0) * (y + 1.0) * (z + 1.0));
  return boxMesh(def.box->size, def.box->cells);
}

TetMesh meshOf(const SoftBodyDef& def) {
  TetMesh mesh = formOf(def);
  for (Vec3& node : mesh.nodes) node *= def.scale;
  orient(mesh);
  requireCount(static_cast<double>(mesh.nodes.size()));
  return mesh;
}

// kg by node: a quarter of each of its tetrahedra.
std::vector<double> massesOf(const TetMesh& mesh, const SoftMatter& matter) {
  if (matter.nodeMass) return std::vector<double>(mesh.nodes.size(), *matter.nodeMass);
  const double density =
      matter.mass ? *matter.mass / volumeOf(mesh) : matter.density.value_or(kWaterDensity);
  std::vector<double> masses(mesh.nodes.size());
  for (const std::array<int, 4>& tet : mesh.tets) {
    for (const int corner : tet) masses[corner] += 0.25 * density * volumeOf(mesh, tet);
  }
  return masses;
}

// Nodes on the side that is farthest along an axis of the mesh.
std::vector<bool> fixedNodes(const TetMesh& mesh, SoftPins pins) {
  std::vector<bool> fixed(mesh.nodes.size());
  if (pins == SoftPins::kNone) return fixed;
  const bool sideways = pins == SoftPins::kLeft || pins == SoftPins::kRight;
  const double sign = pins == SoftPins::kLeft || pins == SoftPins::kBottom ? -1 : 1;
  const Vec3 axis = sign * (sideways ? Vec3::UnitX() : Vec3::UnitY());
  double most = -std::numeric_limits<double>::infinity(), least = -most;
  for (const Vec3& node : mesh.nodes) {
    most = std::max(most, axis.dot(node));
    least = std::min(least, axis.dot(node));
  }
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    fixed[i] = axis.dot(mesh.nodes[i]) > most - 1e-6 * (most - least);
  }
  return fixed;
}

void addVolumes(World& world, const SoftBodyDef& def, const TetMesh& mesh,
                const std::vector<BodyId>& nodes) {
  if (!def.volume) return;
  for (const std::array<int, 4>& tet : mesh.tets) {
    VolumeDef volume;
    for (int i = 0; i < 4; ++i) volume.bodies[i] = nodes[tet[i]];
    volume.volume = volumeOf(mesh, tet);
    // c = 6 (V - V0) with energy K (V - V0)^2 / (2 V0)
    if (def.bulkModulus) volume.compliance = 36 * *volume.volume / *def.bulkModulus;
    if (anyMoves(world, volume.bodies)) world.add(volume);
  }
}

// Nodes and edges of the skin touch, and no others.
void touch(World& world, const SoftBodyDef& def, const SoftParts& parts) {
  SoftSurfaceDef surface;
  std::vector<bool> outside(parts.nodes.size());
  for (const std::array<int, 3>& triangle : parts.triangles) {
    for (const int corner : triangle) outside[corner] = true;
  }
  for (std::size_t i = 0; i < outside.size(); ++i) {
    if (outside[i]) surface.nodes.push_back(parts.nodes[i]);
  }
  for (const auto& [a, b] : edgesOf(parts.triangles)) {
    surface.links.push_back({parts.nodes[a], parts.nodes[b]});
  }
  surface.radius = def.radius;
  surface.friction = world.bodies().friction[parts.nodes[0]];
  world.add(surface);
}

}  // namespace

SoftParts add(World& world, const SoftBodyDef& def) {
  const TetMesh mesh = meshOf(def);
  const std::vector<double> masses = massesOf(mesh, def.matter);
  const std::vector<bool> fixed = fixedNodes(mesh, def.pins);
  SoftParts parts;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3 place = def.place({mesh.nodes[i].cwiseProduct(def.startScale), Quat::Identity()}).x;
    parts.nodes.push_back(addNode(world, place, masses[i], fixed[i], def.matter));
    if (!fixed[i]) world.setVelocity(parts.nodes.back(), def.velocity);
  }
  parts.triangles = skinOf(mesh);
  for (const auto& [a, b] : edgesOf(mesh)) {
    addEdge(world, parts.nodes[a], parts.nodes[b], def.edge,
            (mesh.nodes[a] - mesh.nodes[b]).norm());
  }
  addVolumes(world, def, mesh, parts.nodes);
  touch(world, def, parts);
  return parts;
}

}  // namespace physics
