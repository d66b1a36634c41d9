// World + Appearance -> Picture: an instance per body, a ground, a camera, and what was asked to be
// seen.
#include "scenes/view/view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/base/rotation.h"
#include "physics/bodies/compound.h"
#include "scenes/measure/metrics.h"
#include "scenes/read/recipe.h"
#include "scenes/view/camera.h"
#include "scenes/view/overlays.h"
#include "scenes/view/rods.h"
#include "scenes/view/shape_mesh.h"
#include "scenes/view/stage.h"

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

// Of all ground of triangles.
double lowestGround(const physics::Bodies& bodies) {
  double lowest = std::numeric_limits<double>::infinity();
  for (BodyId b = 1; b < bodies.size(); ++b) {
    const auto* ground = std::get_if<physics::Triangles>(&bodies.shape[b]);
    if (ground != nullptr) lowest = std::min(lowest, lowestOf(*ground, bodies.pose[b]));
  }
  return lowest;
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
  if (!std::isfinite(height)) height = std::min(stage.low.y() - 0.1 * radius, lowestGround(bodies));
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
  } else if (std::holds_alternative<physics::Convex>(shape) ||
             std::holds_alternative<physics::Triangles>(shape)) {
    instance.primitive = Primitive::kMesh;
  } else {
    rounded(Primitive::kSphere, 0.5 * pointDiameter, pointDiameter);
  }
}

void drawBody(const physics::Shape& shape, const physics::Pose& pose,
              const std::shared_ptr<const render::Mesh>& mesh, const render::Color& color,
              bool turns, render::Picture& picture) {
  render::Instance instance;
  setShape(shape, 0.025 * picture.focusRadius, instance);
  instance.marked = instance.marked && turns;
  instance.position = pose.x.cast<float>();
  instance.orientation = pose.q.cast<float>();
  instance.mesh = mesh;
  instance.color = color;
  picture.instances.push_back(std::move(instance));
}

void drawParts(const physics::Compound& compound, const physics::Pose& pose,
               const std::vector<PartLook>& looks, const render::Color& color, bool turns,
               render::Picture& picture) {
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const physics::Part& part = compound.parts->list[i];
    drawBody(part.shape, physics::placed(pose, part.pose), looks[i].mesh,
             looks[i].color.value_or(color), turns, picture);
  }
}

bool isDrawn(const Simulation& simulation, BodyId b) {
  return !isGround(simulation.world().bodies(), b) && !simulation.appearance().hidden[b];
}

void drawBodies(const Simulation& simulation, const MotionBounds& stage, render::Picture& picture) {
  const physics::Bodies& bodies = simulation.world().bodies();
  const Simulation::Appearance& appearance = simulation.appearance();
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (!isDrawn(simulation, b)) continue;
    const bool turns = bodies.motion[b] != Motion::kStatic;
    if (const auto* several = std::get_if<physics::Compound>(&bodies.shape[b])) {
      drawParts(*several, bodies.pose[b], appearance.parts.at(b), appearance.colors[b], turns,
                picture);
      continue;
    }
    const auto* plane = std::get_if<physics::Plane>(&bodies.shape[b]);
    if (plane == nullptr) {
      drawBody(bodies.shape[b], bodies.pose[b], appearance.meshes[b], appearance.colors[b], turns,
               picture);
      continue;
    }
    render::Instance instance = plate(*plane, bodies.pose[b], stage);
    instance.color = appearance.colors[b];
    picture.instances.push_back(std::move(instance));
  }
}

void setCamera(const Simulation& simulation, const CameraDef& def, const MotionBounds& stage,
               double aspect, render::Picture& picture) {
  if (def.keys.empty()) {
    const double ground = picture.ground.visible ? picture.ground.height : -1e9;
    picture.camera = fitCamera(def, stage, aspect, ground);
    picture.focusCenter = centreOf(stage).cast<float>();
    picture.focusRadius = static_cast<float>(radiusOf(stage));
    if (def.follow.any.empty()) return;
  } else {
    picture.camera = keyCamera(simulation, def);
  }
  const float distance = (picture.camera.eye - picture.camera.target).norm();
  const double slope = std::tan(picture.camera.fieldOfViewDegrees * M_PI / 360);
  picture.focusCenter = picture.camera.target;
  picture.focusRadius = distance * static_cast<float>(slope * std::max(1.0, aspect));
}

void setLooks(const Scene& scene, render::Picture& picture) {
  const LightDef& light = scene.light;
  picture.light.shadows = light.shadows;
  if (light.direction) picture.light.direction = light.direction->cast<float>();
  if (light.softnessDegrees) {
    picture.light.softness = static_cast<float>(std::tan(*light.softnessDegrees * M_PI / 180));
  }
  if (light.color) {  // sRGB to linear, near enough for the colour of a light
    picture.light.color = light.color->head<3>().array().pow(2.2f).matrix();
  }
  if (scene.background) picture.background = *scene.background;
}

double timeOf(const Simulation& simulation) {
  return static_cast<double>(simulation.frame()) / simulation.scene().fps;
}

void drawLabels(const Simulation& simulation, double ink, render::Picture& picture) {
  for (render::Label& label : labels(simulation)) {
    if (label.text.empty()) continue;
    label.size *= static_cast<float>(ink);
    picture.labels.push_back(std::move(label));
  }
}

}  // namespace

render::Camera keyCamera(const Simulation& simulation, const CameraDef& def) {
  render::Camera camera = keyCamera(def.keys, timeOf(simulation));
  const Vec3f now = followed(simulation, def, simulation.world().bodies().pose).cast<float>();
  camera.eye += now;
  camera.target += now;
  return camera;
}

std::vector<render::Label> labels(const Simulation& simulation) {
  constexpr double kSlack = 1e-9;  // s
  const physics::Bodies& bodies = simulation.world().bodies();
  const double time = timeOf(simulation);
  std::vector<render::Label> all;
  for (const LabelDef& def : simulation.scene().labels) {
    render::Label& label = all.emplace_back();
    label.size = static_cast<float>(def.size);
    const BodyId body = def.body.empty() ? physics::kWorldBody : simulation.findBody(def.body);
    if (body < 0) continue;
    label.at = (bodies.pose[body].x + def.at).cast<float>();
    const bool late = time > def.to.value_or(time) + kSlack;
    if (!late && time >= def.from.value_or(time) - kSlack) label.text = def.text;
  }
  return all;
}

std::vector<BodyId> drawnBodies(const Simulation& simulation) {
  const physics::Bodies& bodies = simulation.world().bodies();
  std::vector<BodyId> drawn;
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (!isDrawn(simulation, b)) continue;
    const auto* several = std::get_if<physics::Compound>(&bodies.shape[b]);
    drawn.insert(drawn.end(), several == nullptr ? 1 : several->parts->list.size(), b);
  }
  return drawn;
}

render::Picture view(const Simulation& simulation, const MotionBounds& bounds,
                     const ViewOptions& options, const std::vector<FrameMetrics>& history) {
  const CameraDef& camera = options.camera ? *options.camera : simulation.scene().camera;
  const MotionBounds stage = stageOf(simulation, bounds, camera);
  render::Picture picture;
  picture.ground = groundOf(simulation.world().bodies(), stage);
  picture.ground.visible = options.ground;
  setLooks(simulation.scene(), picture);
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
  drawLabels(simulation, options.ink, picture);
  if (options.hud) picture.hud = makeHud(simulation, history);
  if (options.hud && options.trustedUntil) addTrust(simulation, *options.trustedUntil, picture.hud);
  return picture;
}

}  // namespace scenes
