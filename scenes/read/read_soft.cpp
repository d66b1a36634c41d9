// [[rope]] [[cloth]] [[soft_body]]: points, what they are joined by, and what is seen of them.
#include <fmt/format.h>

#include <algorithm>

#include "physics/make/cloth.h"
#include "physics/make/rope.h"
#include "physics/make/soft_body.h"
#include "scenes/read/read_body.h"
#include "scenes/read/recipe.h"
#include "scenes/read/whole_velocity.h"

namespace scenes {
namespace {

using physics::BodyId;

constexpr int kMostLines = 40;  // of a cloth's grid, in each direction

// How points are seen: as the sheet they span, or as points with their links.
constexpr const char* kLooks[] = {"surface", "net"};

struct Look {
  bool net = false;
  std::optional<render::Color> color;
  WholeVelocity start;  // of a rope or cloth
};

Look readLook(TableReader& reader) {
  Look look;
  look.net = reader.choose("draw", kLooks, 0) == 1;
  readColor(reader, look.color);
  return look;
}

void checkMatter(const TableReader& reader) {
  reader.atMostOne("mass", "node_mass");
  reader.atMostOne("mass", "density");
  reader.atMostOne("node_mass", "density");
}

// What only springs or only links have is an error with the others.
void checkEdges(const TableReader& reader, physics::Edges edges) {
  const auto refuse = [&](std::initializer_list<const char*> keys, const char* word) {
    for (const char* key : keys) {
      if (reader.has(key)) reader.failAt(key, fmt::format("expected edges = '{}' as well", word));
    }
  };
  if (edges != physics::Edges::kSprings) refuse({"stiffness", "damping"}, "springs");
  if (edges != physics::Edges::kLinks) refuse({"compliance", "stretch_only"}, "links");
}

render::Color backOf(const render::Color& front) {
  const render::Color white(1, 1, 1, front.w());
  return 0.55f * front + 0.45f * white;
}

// Only nodes of triangles are seen: the others lie inside.
void showSurface(Built& built, const physics::SoftParts& parts, SoftSurface surface) {
  std::vector<int> seen(parts.nodes.size(), -1);
  for (const BodyId node : parts.nodes) built.appearance.hidden[node] = true;
  for (std::array<int, 3> triangle : parts.triangles) {
    for (int& corner : triangle) {
      int& place = seen[corner];
      if (place < 0) {
        place = static_cast<int>(surface.nodes.size());
        surface.nodes.push_back(parts.nodes[corner]);
      }
      corner = place;
    }
    surface.triangles.push_back(triangle);
  }
  built.appearance.surfaces.push_back(std::move(surface));
}

// The colour that all of these bodies have.
render::Color nameNodes(Built& built, const std::vector<BodyId>& nodes, const std::string& name,
                        const Look& look) {
  const render::Color color = look.color.value_or(familyColor(Pattern::kSingle, built.families, 0));
  built.nameAll(nodes, name, Pattern::kSingle, color);
  return color;
}

void buildCloth(Built& built, const physics::ClothDef& def, const std::string& name,
                const Look& look) {
  const physics::SoftParts parts = physics::add(built.world, def);
  look.start.give(built.world, parts.nodes);
  const render::Color color = nameNodes(built, parts.nodes, name, look);
  const int wide = def.nodes.i, high = def.nodes.j;
  for (int k = 0; k < wide * high; ++k) {
    built.alias(parts.nodes[k], fmt::format("{}.{}.{}", name, k % wide, k / wide));
  }
  if (look.net) return;
  SoftSurface surface;
  surface.front = color;
  surface.back = backOf(color);
  const int step = (std::max(wide, high) + kMostLines - 1) / kMostLines;
  const auto share = [&](int i) { return static_cast<float>(i) / static_cast<float>(step); };
  for (int k = 0; k < wide * high; ++k) surface.grid.emplace_back(share(k % wide), share(k / wide));
  for (const BodyId node : parts.nodes) {
    built.appearance.hidden[node] = true;
    surface.nodes.push_back(node);
  }
  surface.triangles = parts.triangles;
  built.appearance.surfaces.push_back(std::move(surface));
}

void buildSoftBody(Built& built, const physics::SoftBodyDef& def, const std::string& name,
                   const Look& look) {
  const physics::SoftParts parts = physics::add(built.world, def);
  const render::Color color = nameNodes(built, parts.nodes, name, look);
  if (look.net) return;
  SoftSurface surface;
  surface.front = surface.back = color;
  surface.offset = def.radius;
  showSurface(built, parts, std::move(surface));
}

void buildRope(Built& built, const physics::RopeDef& def, const std::string& name,
               const Look& look) {
  const std::vector<BodyId> nodes = physics::add(built.world, def);
  look.start.give(built.world, nodes);
  const render::Color color = nameNodes(built, nodes, name, look);
  built.alias(nodes.back(), name + ".end");
  if (look.net) return;
  for (const BodyId node : nodes) built.appearance.hidden[node] = true;
  built.appearance.tubes.push_back({nodes, def.radius, color});
}

// pins = "top_row" or [[0, 0], [19, 0]].
void readClothPins(TableReader& reader, physics::ClothDef& def) {
  const Value* pins = reader.take("pins");
  if (pins == nullptr) return;
  const Spot spot = reader.spot({"pins", physics::Unit::kNone, false, 0});
  if (pins->isArray()) return readValue(*pins, spot, def.pinned);
  readValue(*pins, spot, def.pins);
}

}  // namespace

void readRope(TableReader& reader, Recipe& recipe) {
  physics::RopeDef def;
  const std::string name = readName(reader, def.kWord);
  physics::RopeDef::fields(reader, def);
  checkMatter(reader);
  reader.exactlyOne("to", "direction");
  reader.atMostOne("length", "slack");
  Look look = readLook(reader);
  look.start.read(reader);
  recipe.add(reader, [=](Built& built) { buildRope(built, def, name, look); });
}

void readCloth(TableReader& reader, Recipe& recipe) {
  physics::ClothDef def;
  const std::string name = readName(reader, def.kWord);
  physics::ClothDef::fields(reader, def);
  readClothPins(reader, def);
  checkMatter(reader);
  checkEdges(reader, def.edge.edges);
  if (reader.has("shear_compliance") && !def.shear) {
    reader.failAt("shear_compliance", "expected shear = true as well");
  }
  Look look = readLook(reader);
  look.start.read(reader);
  recipe.add(reader, [=](Built& built) { buildCloth(built, def, name, look); });
}

void readSoftBody(TableReader& reader, Recipe& recipe) {
  physics::SoftBodyDef def;
  const std::string name = readName(reader, def.kWord);
  physics::SoftBodyDef::fields(reader, def);
  reader.atMostOne("box", "mesh");
  reader.atMostOne("box", "ball");
  reader.atMostOne("ball", "mesh");
  if (!def.box && !def.ball && !def.mesh) reader.failHere("expected 'box', 'ball' or 'mesh'");
  checkMatter(reader);
  checkEdges(reader, def.edge.edges);
  const Look look = readLook(reader);
  recipe.add(reader, [=](Built& built) { buildSoftBody(built, def, name, look); });
}

}  // namespace scenes
