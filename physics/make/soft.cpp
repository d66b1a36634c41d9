// Nodes and edges for the generators of ropes, cloths and soft bodies.
#include "physics/make/soft.h"

namespace physics {
double nodeMassOf(const SoftMatter& matter, double volume, int count) {
  if (matter.nodeMass) return *matter.nodeMass;
  return matter.mass.value_or(volume * matter.density.value_or(kWaterDensity)) / count;
}

BodyId addNode(World& world, const Vec3& at, double mass, bool fixed, const SoftMatter& matter) {
  BodyDef def;
  def.shape = PointShape{};
  def.mass = mass;
  def.pose.x = at;
  def.motion = fixed ? Motion::kStatic : Motion::kDynamic;
  def.friction = matter.friction;
  return world.add(def);
}

bool anyMoves(const World& world, std::span<const BodyId> bodies) {
  for (const BodyId body : bodies) {
    if (world.bodies().motion[body] == Motion::kDynamic) return true;
  }
  return false;
}

void addEdge(World& world, BodyId a, BodyId b, const EdgeMatter& matter,
             std::optional<double> length) {
  const std::array<BodyId, 2> bodies{a, b};
  if (matter.edges == Edges::kNone || !anyMoves(world, bodies)) return;
  if (matter.edges == Edges::kLinks) {
    LinkDef link;
    link.bodies = bodies;
    link.length = length;
    link.rope = matter.stretchOnly;
    link.compliance = matter.compliance;
    world.add(link);
    return;
  }
  SpringDef spring;
  spring.bodies = bodies;
  spring.restLength = length;
  spring.stiffness = matter.stiffness;
  spring.damping = matter.damping;
  world.add(spring);
}

void addBending(World& world, std::span<const BodyId> row, const Bending& bending) {
  if (bending.stiffness == 0 && bending.damping == 0) return;
  for (std::size_t i = 2; i < row.size(); ++i) {
    if (!anyMoves(world, row.subspan(i - 2, 3))) continue;
    BendDef bend;
    bend.bodies = {row[i - 2], row[i - 1], row[i]};
    bend.stiffness = bending.stiffness;
    bend.damping = bending.damping;
    world.add(bend);
  }
}

void attach(World& world, BodyId node, BodyId body) {
  world.ignoreCollision(body, node);
  if (!anyMoves(world, std::array{node, body})) return;
  BallSocketDef joint;
  joint.bodies = {body, node};
  joint.at = world.bodies().pose[node].x;
  world.add(joint);
}

}  // namespace physics
