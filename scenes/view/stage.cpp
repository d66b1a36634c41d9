// Bounds of shapes as they are turned, over time and around what stands still.
#include "scenes/view/stage.h"

#include <algorithm>

#include "physics/bodies/compound.h"
#include "physics/bodies/triangles.h"
#include "scenes/view/rods.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Motion;
using physics::Vec3;

bool isEmpty(const MotionBounds& box) { return (box.low.array() > box.high.array()).any(); }

void include(const Vec3& low, const Vec3& high, MotionBounds& box) {
  box.low = box.low.cwiseMin(low);
  box.high = box.high.cwiseMax(high);
}

// Half the extents along the world's axes, where that is the same on both sides.
Vec3 halfExtents(const physics::Shape& shape, const Eigen::Matrix3d& turn) {
  const Vec3 axis = turn.col(1);
  if (const auto* shapeBox = std::get_if<physics::Box>(&shape)) {
    return 0.5 * turn.cwiseAbs() * shapeBox->size;
  }
  if (const auto* capsule = std::get_if<physics::Capsule>(&shape)) {
    return 0.5 * capsule->length * axis.cwiseAbs() + Vec3::Constant(capsule->radius);
  }
  if (const auto* cylinder = std::get_if<physics::Cylinder>(&shape)) {
    const Vec3 across = (Vec3::Ones() - axis.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
    return 0.5 * cylinder->length * axis.cwiseAbs() + cylinder->radius * across;
  }
  return Vec3::Constant(physics::boundingRadius(shape));
}

void include(const std::vector<Vec3>& vertices, const physics::Pose& pose, MotionBounds& box) {
  for (const Vec3& vertex : vertices) {
    const Vec3 at = pose.x + pose.q * vertex;
    include(at, at, box);
  }
}

void include(const physics::Shape& shape, const physics::Pose& pose, MotionBounds& box) {
  if (const auto* convex = std::get_if<physics::Convex>(&shape)) {
    return include(convex->hull->vertices, pose, box);
  }
  if (const auto* ground = std::get_if<physics::Triangles>(&shape)) {
    return include(ground->mesh->vertices, pose, box);
  }
  if (const auto* several = std::get_if<physics::Compound>(&shape)) {
    for (const physics::Part& part : several->parts->list) {
      include(part.shape, physics::placed(pose, part.pose), box);
    }
    return;
  }
  const Vec3 half = halfExtents(shape, pose.q.toRotationMatrix());
  include(pose.x - half, pose.x + half, box);
}

// Where rods end at what does not move: a pendulum is seen with what it hangs from.
void includeAnchors(const Simulation& simulation, const CameraDef& camera, MotionBounds& stage) {
  const physics::Bodies& bodies = simulation.world().bodies();
  for (const physics::JointReport& joint : simulation.world().joints()) {
    if (!isHeldByTheWorld(bodies, joint)) continue;
    const bool fromA = bodies.motion[joint.a] == Motion::kStatic;
    const BodyId held = fromA ? joint.b : joint.a;
    const Vec3& anchor = fromA ? joint.pointA : joint.pointB;
    const bool drawn = isRod(joint.kind) ||
                       isHeldFromAfar(bodies, joint, held, fromA ? joint.pointB : joint.pointA);
    if (drawn && simulation.isMeant(camera.fit, held)) include(anchor, anchor, stage);
  }
}

}  // namespace

bool isPlane(const physics::Bodies& bodies, BodyId b) {
  return std::holds_alternative<physics::Plane>(bodies.shape[b]);
}

double radiusOf(const MotionBounds& box) { return 0.5 * (box.high - box.low).norm(); }
Vec3 centreOf(const MotionBounds& box) { return 0.5 * (box.low + box.high); }

Vec3 followed(const Simulation& simulation, const CameraDef& camera,
              std::span<const physics::Pose> poses) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  if (camera.follow.any.empty()) return sum;
  for (BodyId b = 1; b < simulation.world().bodyCount(); ++b) {
    if (isPlane(simulation.world().bodies(), b)) continue;
    if (!simulation.isMeant(camera.follow, b)) continue;
    sum += poses[static_cast<size_t>(b)].x;
    ++count;
  }
  return count == 0 ? sum : Vec3(sum / count);
}

MotionBounds stageOf(const Simulation& simulation, const MotionBounds& motion,
                     const CameraDef& camera) {
  MotionBounds stage = motion;
  if (isEmpty(stage)) stage.include(simulation, camera);
  const physics::Bodies& bodies = simulation.world().bodies();
  if (!camera.follow.any.empty()) {
    const Vec3 now = followed(simulation, camera, bodies.pose);
    stage.low += now;
    stage.high += now;
    return stage;
  }
  const double largest = isEmpty(stage) ? 1e9 : radiusOf(stage);
  for (BodyId b = 1; b < bodies.size(); ++b) {
    const bool wanted = simulation.isMeant(camera.fit, b);
    if (!wanted || bodies.motion[b] != Motion::kStatic || isPlane(bodies, b)) continue;
    if (physics::boundingRadius(bodies.shape[b]) <= largest) {
      include(bodies.shape[b], bodies.pose[b], stage);
    }
  }
  includeAnchors(simulation, camera, stage);
  if (isEmpty(stage)) stage = {Vec3::Zero(), Vec3::Zero()};
  if (stage.low == stage.high) {  // nothing, or a point that rests
    stage.low -= Vec3::Ones();
    stage.high += Vec3::Ones();
  }
  return stage;
}

void MotionBounds::include(const Simulation& simulation) {
  include(simulation, simulation.scene().camera);
}

void MotionBounds::include(const Simulation& simulation, const CameraDef& camera) {
  include(simulation, camera, simulation.world().bodies().pose);
}

void MotionBounds::include(const Simulation& simulation, const CameraDef& camera,
                           std::span<const physics::Pose> poses) {
  const physics::Bodies& bodies = simulation.world().bodies();
  const Vec3 middle = followed(simulation, camera, poses);
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] == Motion::kStatic || isPlane(bodies, b)) continue;
    if (!simulation.isMeant(camera.fit, b)) continue;
    physics::Pose pose = poses[static_cast<size_t>(b)];
    pose.x -= middle;
    scenes::include(bodies.shape[b], pose, *this);
  }
}

bool needsMotionBounds(const Scene& scene) {
  return scene.camera.keys.empty() || scene.film.moments > 1;
}

}  // namespace scenes
