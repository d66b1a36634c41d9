// Nodes, edges, total lengths, bending and air of a grid.
#include "physics/make/cloth.h"

#include "physics/make/placement.h"

namespace physics {
namespace {

// The grid under construction: rows and columns of bodies.
struct Grid {
  const ClothDef& def;
  std::vector<BodyId> nodes;
  std::vector<Vec3> places;  // without scatter

  int wide() const { return def.nodes.i; }
  int high() const { return def.nodes.j; }
  int index(int i, int j) const { return j * wide() + i; }
  BodyId at(int i, int j) const { return nodes[index(i, j)]; }
  // Between two nodes; absent: as they start.
  std::optional<double> length(int a, int b) const {
    if (def.scatter == 0) return {};
    return (places[a] - places[b]).norm();
  }
  std::vector<BodyId> row(int j) const {
    return {nodes.begin() + index(0, j), nodes.begin() + index(0, j + 1)};
  }
  std::vector<BodyId> column(int i) const {
    std::vector<BodyId> bodies;
    for (int j = 0; j < high(); ++j) bodies.push_back(at(i, j));
    return bodies;
  }
};

std::string named(const GridIndex& node) {
  std::string text = "[";
  text += std::to_string(node.i) + ", " + std::to_string(node.j) + "]";
  return text;
}

void requireInside(const ClothDef& def, const GridIndex& node) {
  require(node.i >= 0 && node.j >= 0 && node.i < def.nodes.i && node.j < def.nodes.j,
          "expected a node of the grid of " + named(def.nodes) + ", got " + named(node));
}

// Which nodes never move: pinned ones, and those that are attached to what never moves.
std::vector<bool> fixedNodes(const World& world, const ClothDef& def) {
  std::vector<bool> fixed(static_cast<std::size_t>(def.nodes.i) * def.nodes.j);
  const auto pin = [&](const GridIndex& node) {
    requireInside(def, node);
    fixed[node.j * def.nodes.i + node.i] = true;
  };
  const int right = def.nodes.i - 1, bottom = def.nodes.j - 1;
  if (def.pins == ClothPins::kTopRow) {
    for (int i = 0; i <= right; ++i) pin({i, 0});
  } else if (def.pins != ClothPins::kNone) {
    pin({0, 0});
    pin({right, 0});
  }
  if (def.pins == ClothPins::kFourCorners) {
    pin({0, bottom});
    pin({right, bottom});
  }
  for (const GridIndex& node : def.pinned) pin(node);
  for (const ClothAttachment& held : def.attach) {
    requireInside(def, held.node);
    require(!fixed[held.node.j * def.nodes.i + held.node.i],
            "expected node " + named(held.node) + " to be pinned or attached, not both");
    if (world.bodies().motion[held.body.id] == Motion::kStatic) pin(held.node);
  }
  return fixed;
}

// By node, how far it starts from its place.
std::vector<Vec3> scattered(const ClothDef& def, const std::vector<bool>& fixed) {
  std::vector<bool> held = fixed;
  for (const ClothAttachment& by : def.attach) held[by.node.j * def.nodes.i + by.node.i] = true;
  std::vector<Vec3> shifts(fixed.size(), Vec3::Zero());
  Random random(def.seed);
  for (std::size_t k = 0; k < shifts.size(); ++k) {
    if (def.scatter > 0 && !held[k]) shifts[k] = random.inBall(def.scatter);
  }
  return shifts;
}

void addNodes(World& world, Grid& grid) {
  const ClothDef& def = grid.def;
  const std::vector<bool> fixed = fixedNodes(world, def);
  const Vec3 u = def.size.x() * def.u.normalized(), v = def.size.y() * def.v.normalized();
  require(u.cross(v).norm() > 1e-6 * u.norm() * v.norm(),
          "expected 'u' and 'v' not to be parallel");
  const double volume = u.cross(v).norm() * 2 * def.radius;
  const double mass = nodeMassOf(def.matter, volume, grid.wide() * grid.high());
  const std::vector<Vec3> shifts = scattered(def, fixed);
  for (int j = 0; j < grid.high(); ++j) {
    for (int i = 0; i < grid.wide(); ++i) {
      const double s = static_cast<double>(i) / (grid.wide() - 1) - 0.5;
      const double t = static_cast<double>(j) / (grid.high() - 1) - 0.5;
      const int k = grid.index(i, j);
      grid.places.emplace_back(def.position + s * u + t * v);
      const Vec3 start = grid.places[k] + shifts[k];
      grid.nodes.push_back(addNode(world, start, mass, fixed[k], def.matter));
    }
  }
}

// Links of the grid: those it touches other things with.
std::vector<std::array<int, 2>> threads(const Grid& grid) {
  std::vector<std::array<int, 2>> links;
  for (int j = 0; j < grid.high(); ++j) {
    for (int i = 0; i < grid.wide(); ++i) {
      if (i > 0) links.push_back({grid.index(i - 1, j), grid.index(i, j)});
      if (j > 0) links.push_back({grid.index(i, j - 1), grid.index(i, j)});
    }
  }
  return links;
}

void addEdges(World& world, const Grid& grid) {
  const ClothDef& def = grid.def;
  const auto join = [&](int a, int b, const EdgeMatter& matter) {
    addEdge(world, grid.nodes[a], grid.nodes[b], matter, grid.length(a, b));
  };
  for (const auto& [a, b] : threads(grid)) join(a, b, def.edge);
  if (!def.shear) return;
  EdgeMatter diagonal = def.edge;
  diagonal.compliance = def.shearCompliance;
  for (int j = 1; j < grid.high(); ++j) {
    for (int i = 1; i < grid.wide(); ++i) {
      join(grid.index(i - 1, j - 1), grid.index(i, j), diagonal);
      join(grid.index(i, j - 1), grid.index(i - 1, j), diagonal);
    }
  }
}

void addLines(World& world, const Grid& grid) {
  const auto addLine = [&](const std::vector<BodyId>& line, double length) {
    addBending(world, line, grid.def.bending);
    if (!grid.def.totalLength || line.size() < 3 || !anyMoves(world, line)) return;
    RopeLengthDef total;
    total.bodies = line;
    if (grid.def.scatter > 0) total.length = length;
    world.add(total);
  };
  for (int j = 0; j < grid.high(); ++j) addLine(grid.row(j), grid.def.size.x());
  for (int i = 0; i < grid.wide(); ++i) addLine(grid.column(i), grid.def.size.y());
}

// Two to a cell, front side out; diagonals alternate, so that no direction is preferred.
std::vector<std::array<int, 3>> trianglesOf(const Grid& grid) {
  std::vector<std::array<int, 3>> triangles;
  for (int j = 1; j < grid.high(); ++j) {
    for (int i = 1; i < grid.wide(); ++i) {
      const int a = grid.index(i - 1, j - 1), b = grid.index(i, j - 1), c = grid.index(i - 1, j),
                d = grid.index(i, j);
      if ((i + j) % 2 == 0) {
        triangles.push_back({a, c, d});
        triangles.push_back({a, d, b});
      } else {
        triangles.push_back({a, c, b});
        triangles.push_back({b, c, d});
      }
    }
  }
  return triangles;
}

void addAir(World& world, const AirDrag& air, const SoftParts& parts) {
  for (const auto& [a, b, c] : parts.triangles) {
    PanelDragDef panel;
    panel.bodies = {parts.nodes[a], parts.nodes[b], parts.nodes[c]};
    panel.coefficient = air.coefficient;
    panel.wind = air.wind;
    if (anyMoves(world, panel.bodies)) world.add(panel);
  }
}

}  // namespace

SoftParts add(World& world, const ClothDef& def) {
  require(def.nodes.i >= 2 && def.nodes.j >= 2, "expected at least 2 x 2 nodes");
  requireCount(static_cast<double>(def.nodes.i) * def.nodes.j);
  Grid grid{def, {}, {}};
  addNodes(world, grid);
  addEdges(world, grid);
  addLines(world, grid);
  SoftParts parts{grid.nodes, trianglesOf(grid)};
  if (def.drag) addAir(world, *def.drag, parts);
  for (const ClothAttachment& held : def.attach) {
    attach(world, grid.at(held.node.i, held.node.j), held.body.id);
  }
  SoftSurfaceDef surface;
  surface.nodes = parts.nodes;
  for (const auto& [a, b] : threads(grid)) surface.links.push_back({grid.nodes[a], grid.nodes[b]});
  surface.radius = def.radius;
  surface.friction = world.bodies().friction[parts.nodes[0]];
  world.add(surface);
  return parts;
}

}  // namespace physics
