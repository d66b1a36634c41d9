// World + Appearance -> Picture: an instance per body, a ground, a camera, and what was asked to be
// seen.
#include "scenes/view/view.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "scenes/measure/metrics.h"
#include "scenes/read/recipe.h"
#include "scenes/view/camera.h"
#include "scenes/view/overlays.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Motion;
using physics::Vec3;
using render::Primitive;
using render::Vec3f;

bool isGround(const physics::Bodies& bodies, BodyId b) {
  const auto* plane = std::get_if<physics::Plane>(&bodies.shape[b]);
  return plane != nullptr && (bodies.pose[b].q * plane->normal).y() > 1 - 1e-9;
}

bool isPlane(const physics::Bodies& bodies, BodyId b) {
  return std::holds_alternative<physics::Plane>(bodies.shape[b]);
}

bool isEmpty(const MotionBounds& box) { return (box.low.array() > box.high.array()).any(); }
double radiusOf(const MotionBounds& box) { return 0.5 * (box.high - box.low).norm(); }
Vec3 centreOf(const MotionBounds& box) { return 0.5 * (box.low + box.high); }

void include(const physics::Shape& shape, const Vec3& x, MotionBounds& box) {
  const double radius = physics::boundingRadius(shape);
  box.low = box.low.cwiseMin(x - Vec3::Constant(radius));
  box.high = box.high.cwiseMax(x + Vec3::Constant(radius));
}

// What the picture is about: the motion, and fixed things of its size that stand around it.
MotionBounds stageOf(const Simulation& simulation, const MotionBounds& motion,
                     const std::string& fit) {
  MotionBounds stage = motion;
  if (isEmpty(stage)) stage.include(simulation, fit);
  const physics::Bodies& bodies = simulation.world().bodies();
  const double largest = isEmpty(stage) ? 1e9 : radiusOf(stage);
  for (BodyId b = 1; b < bodies.size(); ++b) {
    const bool wanted = matches(fit, simulation.bodyName(b));
    if (!wanted || bodies.motion[b] != Motion::kStatic || isPlane(bodies, b)) continue;
    if (physics::boundingRadius(bodies.shape[b]) <= largest) {
      include(bodies.shape[b], bodies.pose[b].x, stage);
    }
  }
  if (isEmpty(stage)) stage = {Vec3::Constant(-1), Vec3::Constant(1)};
  return stage;
}

// The highest level plane, or else a stage a little below all that moves.
render::Ground groundOf(const physics::Bodies& bodies, const MotionBounds& stage) {
  render::Ground ground;
  const double radius = radiusOf(stage);
  double height = -std::numeric_limits<double>::infinity();
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (!isGround(bodies, b)) continue;
    const double offset = std::get<physics::Plane>(bodies.shape[b]).offset;
    height = std::max(height, bodies.pose[b].x.y() + offset);
  }
  if (!std::isfinite(height)) height = stage.low.y() - 0.1 * radius;
  ground.height = static_cast<float>(height);
  ground.spacing = static_cast<float>(std::pow(10.0, std::round(std::log10(radius / 5))));
  return ground;
}

// A plane that is no ground: a plate under the stage's centre, its upper face in the plane.
render::Instance plate(const physics::Plane& plane, const physics::Pose& pose,
                       const MotionBounds& stage) {
  const Vec3 normal = pose.q * plane.normal;
  const double radius = radiusOf(stage), thickness = 0.02 * radius;
  const Vec3 centre = centreOf(stage);
  const double above = normal.dot(centre - pose.x) - plane.offset;
  render::Instance plate;
  plate.size = Vec3(2.4 * radius, thickness, 2.4 * radius).cast<float>();
  plate.position = (centre - (above + 0.5 * thickness) * normal).cast<float>();
  plate.orientation = physics::turnBetween(Vec3::UnitY(), normal).cast<float>();
  return plate;
}

void setShape(const physics::Shape& shape, double pointDiameter, render::Instance& instance) {
  const auto rounded = [&](Primitive primitive, double radius, double length) {
    instance.primitive = primitive;
    const double diameter = 2 * radius;
    instance.size = Vec3(diameter, length, diameter).cast<float>();
  };
  if (const auto* box = std::get_if<physics::Box>(&shape)) {
    instance.size = box->size.cast<float>();
  } else if (const auto* sphere = std::get_if<physics::Sphere>(&shape)) {
    rounded(Primitive::kSphere, sphere->radius, 2 * sphere->radius);
    instance.marked = true;
  } else if (const auto* capsule = std::get_if<physics::Capsule>(&shape)) {
    rounded(Primitive::kCapsule, capsule->radius, capsule->length);
  } else if (const auto* cylinder = std::get_if<physics::Cylinder>(&shape)) {
    rounded(Primitive::kCylinder, cylinder->radius, cylinder->length);
    instance.marked = true;
  } else if (std::holds_alternative<physics::Convex>(shape)) {
    instance.primitive = Primitive::kMesh;
  } else {
    rounded(Primitive::kSphere, 0.5 * pointDiameter, pointDiameter);
  }
}

void drawBodies(const Simulation& simulation, const MotionBounds& stage, render::Picture& picture) {
  const physics::Bodies& bodies = simulation.world().bodies();
  const Simulation::Appearance& appearance = simulation.appearance();
  for (const BodyId b : drawnBodies(simulation)) {
    render::Instance instance;
    if (const auto* plane = std::get_if<physics::Plane>(&bodies.shape[b])) {
      instance = plate(*plane, bodies.pose[b], stage);
    } else {
      setShape(bodies.shape[b], 0.025 * picture.focusRadius, instance);
      instance.position = bodies.pose[b].x.cast<float>();
      instance.orientation = bodies.pose[b].q.cast<float>();
    }
    instance.mesh = appearance.meshes[b];
    instance.color = appearance.colors[b];
    picture.instances.push_back(std::move(instance));
  }
}

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

bool isRod(const std::string& kind) {
  for (const char* rod :
       {physics::SpringDef::kWord, physics::VectorSpring::kWord, physics::HardeningSpringDef::kWord,
        physics::DistanceDef::kWord, physics::LinkDef::kWord, physics::RopeLengthDef::kWord}) {
    if (kind == rod) return true;
  }
  return false;
}

// Springs, distances and links have no body of their own: a thin rod from point to point.
void drawRods(const Simulation& simulation, render::Picture& picture) {
  const std::vector<bool>& hidden = simulation.appearance().hidden;
  const render::Color grey(0.3f, 0.3f, 0.3f, 1);
  const std::vector<physics::JointReport> joints = simulation.world().joints();
  const bool linked = std::any_of(joints.begin(), joints.end(), [](const auto& joint) {
    return joint.kind == physics::LinkDef::kWord;
  });
  for (const physics::JointReport& joint : joints) {
    if (!isRod(joint.kind)) continue;
    if (linked && joint.kind == physics::RopeLengthDef::kWord) continue;  // its pieces are links
    if (hidden[joint.a] && hidden[joint.b]) continue;
    if ((joint.pointB - joint.pointA).norm() < 1e-9) continue;
    picture.instances.push_back(
        rod(Primitive::kCylinder, joint.pointA, joint.pointB, 0.012 * picture.focusRadius, grey));
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

void setCamera(const Simulation& simulation, const CameraDef& def, const MotionBounds& stage,
               double aspect, render::Picture& picture) {
  if (def.keys.empty()) {
    const double ground = picture.ground.visible ? picture.ground.height : -1e9;
    picture.camera = fitCamera(def, stage, aspect, ground);
    picture.focusCenter = centreOf(stage).cast<float>();
    picture.focusRadius = static_cast<float>(radiusOf(stage));
    return;
  }
  const double time = static_cast<double>(simulation.frame()) / simulation.scene().fps;
  picture.camera = keyCamera(def.keys, time);
  const float distance = (picture.camera.eye - picture.camera.target).norm();
  const double slope = std::tan(picture.camera.fieldOfViewDegrees * M_PI / 360);
  picture.focusCenter = picture.camera.target;
  picture.focusRadius = distance * static_cast<float>(slope * std::max(1.0, aspect));
}

}  // namespace

void MotionBounds::include(const Simulation& simulation) {
  include(simulation, simulation.scene().camera.fit);
}

void MotionBounds::include(const Simulation& simulation, const std::string& fit) {
  include(simulation, fit, simulation.world().bodies().pose);
}

void MotionBounds::include(const Simulation& simulation, const std::string& fit,
                           std::span<const physics::Pose> poses) {
  const physics::Bodies& bodies = simulation.world().bodies();
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] == Motion::kStatic || isPlane(bodies, b)) continue;
    if (!matches(fit, simulation.bodyName(b))) continue;
    scenes::include(bodies.shape[b], poses[static_cast<size_t>(b)].x, *this);
  }
}

bool needsMotionBounds(const Scene& scene) { return scene.camera.keys.empty(); }

std::vector<BodyId> drawnBodies(const Simulation& simulation) {
  const physics::Bodies& bodies = simulation.world().bodies();
  std::vector<BodyId> drawn;
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (!isGround(bodies, b) && !simulation.appearance().hidden[b]) drawn.push_back(b);
  }
  return drawn;
}

render::Picture view(const Simulation& simulation, const MotionBounds& bounds,
                     const ViewOptions& options, const std::vector<FrameMetrics>& history) {
  const CameraDef& camera = options.camera ? *options.camera : simulation.scene().camera;
  const MotionBounds stage = stageOf(simulation, bounds, camera.fit);
  render::Picture picture;
  picture.ground = groundOf(simulation.world().bodies(), stage);
  picture.ground.visible = options.ground;
  picture.light.shadows = simulation.scene().shadows;
  setCamera(simulation, camera, stage, options.aspect, picture);
  drawBodies(simulation, stage, picture);
  drawRods(simulation, picture);
  drawTubes(simulation, picture);
  drawSurfaces(simulation, picture);
  for (render::Instance& instance : picture.instances) {
    instance.color.w() *= static_cast<float>(options.opacity);
  }
  for (render::Surface& surface : picture.surfaces) {
    surface.color.w() *= static_cast<float>(options.opacity);
    surface.backColor.w() *= static_cast<float>(options.opacity);
  }
  drawOverlays(simulation, options, picture.focusRadius, picture);
  if (options.hud) picture.hud = makeHud(simulation, history);
  if (options.hud && options.trustedUntil) addTrust(simulation, *options.trustedUntil, picture.hud);
  return picture;
}

}  // namespace scenes
