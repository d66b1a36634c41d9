// Thin rods for joints, capsules for tubes, triangles for sheets.
#include "scenes/view/rods.h"

#include <algorithm>

#include "physics/base/rotation.h"
#include "scenes/read/recipe.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Motion;
using physics::Vec3;
using render::Primitive;
using render::Vec3f;

const render::Color kRodColor(0.3f, 0.3f, 0.3f, 1);

render::Instance rod(Primitive primitive, const Vec3& from, const Vec3& to, double diameter,
                     const render::Color& color) {
  const Vec3 along = to - from;
  render::Instance rod;
  rod.primitive = primitive;
  rod.size = Vec3(diameter, along.norm(), diameter).cast<float>();
  rod.position = (0.5 * (from + to)).cast<float>();
  rod.orientation = physics::turnBetween(Vec3::UnitY(), along).cast<float>();
  rod.color = color;
  return rod;
}

// From a body to the point that holds it, and a knob where that stands still.
void drawHolders(const Simulation& simulation, const physics::JointReport& joint,
                 render::Picture& picture) {
  const physics::Bodies& bodies = simulation.world().bodies();
  const std::vector<bool>& hidden = simulation.appearance().hidden;
  const double diameter = 0.012 * picture.focusRadius;
  bool drawn = false;
  for (const auto& [body, point] :
       {std::pair(joint.a, joint.pointA), std::pair(joint.b, joint.pointB)}) {
    if (!isHeldFromAfar(bodies, joint, body, point) || hidden[body]) continue;
    picture.instances.push_back(
        rod(Primitive::kCylinder, bodies.pose[body].x, point, diameter, kRodColor));
    drawn = true;
  }
  if (!drawn || !isHeldByTheWorld(bodies, joint)) return;
  render::Instance knob;
  knob.primitive = Primitive::kSphere;
  knob.size = Vec3f::Constant(static_cast<float>(2.5 * diameter));
  knob.position = joint.pointA.cast<float>();
  knob.color = kRodColor;
  picture.instances.push_back(std::move(knob));
}

}  // namespace

bool isRod(const std::string& kind) {
  for (const char* rod :
       {physics::SpringDef::kWord, physics::VectorSpring::kWord, physics::HardeningSpringDef::kWord,
        physics::DistanceDef::kWord, physics::LinkDef::kWord, physics::RopeLengthDef::kWord}) {
    if (kind == rod) return true;
  }
  return false;
}

bool isHeldFromAfar(const physics::Bodies& bodies, const physics::JointReport& joint, BodyId body,
                    const Vec3& point) {
  if (joint.kind != physics::BallSocketDef::kWord) return false;
  if (bodies.motion[body] == Motion::kStatic) return false;
  const double reach = 1.001 * physics::boundingRadius(bodies.shape[body]);
  return (point - bodies.pose[body].x).norm() > reach;
}

bool isHeldByTheWorld(const physics::Bodies& bodies, const physics::JointReport& joint) {
  return bodies.motion[joint.a] == Motion::kStatic || bodies.motion[joint.b] == Motion::kStatic;
}

void drawRods(const Simulation& simulation, render::Picture& picture) {
  const std::vector<bool>& hidden = simulation.appearance().hidden;
  const std::vector<physics::JointReport> joints = simulation.world().joints();
  const bool linked = std::any_of(joints.begin(), joints.end(), [](const auto& joint) {
    return joint.kind == physics::LinkDef::kWord;
  });
  for (const physics::JointReport& joint : joints) {
    drawHolders(simulation, joint, picture);
    if (!isRod(joint.kind)) continue;
    if (linked && joint.kind == physics::RopeLengthDef::kWord) continue;  // its pieces are links
    if (hidden[joint.a] && hidden[joint.b]) continue;
    if ((joint.pointB - joint.pointA).norm() < 1e-9) continue;
    picture.instances.push_back(rod(Primitive::kCylinder, joint.pointA, joint.pointB,
                                    0.012 * picture.focusRadius, kRodColor));
  }
}

// A tube is a capsule from node to node: joints are round.
void drawTubes(const Simulation& simulation, render::Picture& picture) {
  const std::vector<physics::Pose>& pose = simulation.world().bodies().pose;
  for (const SoftTube& tube : simulation.appearance().tubes) {
    for (size_t i = 1; i < tube.nodes.size(); ++i) {
      const Vec3 &from = pose[tube.nodes[i - 1]].x, &to = pose[tube.nodes[i]].x;
      if ((to - from).norm() < 1e-9) continue;
      picture.instances.push_back(rod(Primitive::kCapsule, from, to, 2 * tube.radius, tube.color));
    }
  }
}

void drawSurfaces(const Simulation& simulation, render::Picture& picture) {
  const std::vector<physics::Pose>& pose = simulation.world().bodies().pose;
  for (const SoftSurface& soft : simulation.appearance().surfaces) {
    render::Surface surface;
    for (const BodyId node : soft.nodes) surface.positions.push_back(pose[node].x.cast<float>());
    for (const std::array<int, 3>& triangle : soft.triangles)
      surface.indices.insert(surface.indices.end(), triangle.begin(), triangle.end());
    surface.grid = soft.grid;
    surface.edges = soft.grid.empty();
    surface.offset = static_cast<float>(soft.offset);
    surface.color = soft.front;
    surface.backColor = soft.back;
    picture.surfaces.push_back(std::move(surface));
  }
}

}  // namespace scenes
