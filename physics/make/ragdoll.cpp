// Figures out of bodies, ball sockets, axles, limits and drives.
#include "physics/make/ragdoll.h"

#include <algorithm>

#include "physics/base/rotation.h"

namespace physics {
namespace {

// A figure under construction. Anchors and axes are taken at rest, in each bone's own frame, so
// that the pose at the start does not matter.
struct Figure {
  World& world;
  const Skeleton& skeleton;
  const RagdollDef& def;
  Ragdoll out;

  const Pose& rest(int bone) const { return skeleton.bones[bone].rest; }
  std::array<BodyId, 2> bodies(const SkeletonJoint& j) const {
    return {out.bones[j.parent], out.bones[j.child]};
  }
  Vec3 toBone(int bone, const Vec3& direction) const {
    return rest(bone).q.conjugate() * direction;
  }
  Vec3 anchor(int bone, const Vec3& point) const { return toBone(bone, point - rest(bone).x); }
  Quat relative(const SkeletonJoint& j, const Quat& turn) const {
    return rest(j.parent).q.conjugate() * turn * rest(j.child).q;
  }
};

void addBones(Figure& figure, const std::vector<Pose>& poses, const Vec3& pivot) {
  for (size_t i = 0; i < poses.size(); ++i) {
    const Bone& bone = figure.skeleton.bones[i];
    BodyDef body;
    body.shape = bone.shape;
    body.mass = bone.mass;
    body.friction = figure.def.friction;
    body.restitution = figure.def.restitution;
    body.pose = poses[i];
    const auto& fixed = figure.def.fixed;
    if (std::find(fixed.begin(), fixed.end(), bone.name) != fixed.end()) {
      body.motion = Motion::kStatic;
    } else if (i == 0 && figure.def.leads) {
      body.motion = Motion::kKinematic;
    } else {
      const Velocity& whole = figure.def.velocity;
      body.velocity = {whole.v + whole.w.cross(poses[i].x - pivot), whole.w};
    }
    figure.out.bones.push_back(figure.world.add(body));
  }
}

// A limit about `axis` of the parent at rest, counted from the child's orientation `zero` turned
// from rest.
void addTwist(Figure& figure, const SkeletonJoint& j, const Vec3& axis, const Quat& zero) {
  TwistLimitDef limit;
  limit.bodies = figure.bodies(j);
  limit.axis = figure.world.bodies().pose[limit.bodies[0]].q * figure.toBone(j.parent, axis);
  limit.range = j.limits;
  limit.reference = figure.relative(j, zero);
  figure.world.add(limit);
}

void addJoint(Figure& figure, const SkeletonJoint& j) {
  BallSocketDef ball;
  ball.bodies = figure.bodies(j);
  ball.anchors = {figure.anchor(j.parent, j.at), figure.anchor(j.child, j.at)};
  figure.world.add(ball);
  if (j.hinge) {
    AxleDef axle;
    axle.bodies = ball.bodies;
    axle.axes = {figure.toBone(j.parent, j.axis), figure.toBone(j.child, j.axis)};
    figure.world.add(axle);
    addTwist(figure, j, j.axis, Quat::Identity());
    return;
  }
  ConeLimitDef cone;
  cone.bodies = ball.bodies;
  cone.axes = {figure.toBone(j.parent, j.centre), figure.toBone(j.child, j.axis)};
  cone.angle = j.cone;
  figure.world.add(cone);
  // Zero twist is the shortest swing to the cone's middle: far from the singular swing of 180
  // degrees.
  addTwist(figure, j, j.centre, turnBetween(j.axis, j.centre));
}

void addDrive(Figure& figure, const SkeletonJoint& j, const Quat& turn) {
  DriveDef drive;
  drive.bodies = figure.bodies(j);
  drive.target = figure.relative(j, turn);
  drive.stiffness = figure.def.drive->stiffness * j.strength;
  drive.damping = figure.def.drive->damping * j.strength;
  drive.maxTorque = figure.def.drive->maxTorque * j.strength;
  figure.out.drives.push_back(figure.world.add(drive));
}

// The pose's bones in the world: turned about the first one, then lowered until the lowest point is
// at the placement's height.
std::vector<Pose> placed(const Skeleton& skeleton, const std::vector<Pose>& poses, const Vec3& at,
                         const Quat& turn) {
  std::vector<Pose> out;
  double lowest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < poses.size(); ++i) {
    const Pose pose{turn * (poses[i].x - poses[0].x), (turn * poses[i].q).normalized()};
    const double below = reach(skeleton.bones[i].shape, pose.q, -Vec3::UnitY());
    lowest = std::min(lowest, pose.x.y() - below);
    out.push_back(pose);
  }
  for (Pose& pose : out) pose.x += at - lowest * Vec3::UnitY();
  return out;
}

}  // namespace

std::vector<Pose> posed(const Skeleton& skeleton, const JointTurns& turns) {
  std::vector<Pose> poses;
  for (const Bone& bone : skeleton.bones) poses.push_back(bone.rest);
  std::vector<Quat> turned(poses.size(), Quat::Identity());  // of each bone, from rest
  for (size_t i = 0; i < skeleton.joints.size(); ++i) {
    const SkeletonJoint& j = skeleton.joints[i];
    const Pose& parentRest = skeleton.bones[j.parent].rest;
    const Pose& childRest = skeleton.bones[j.child].rest;
    turned[j.child] = turned[j.parent] * turns[i];
    const Vec3 at = poses[j.parent].x + turned[j.parent] * (j.at - parentRest.x);
    poses[j.child].x = at + turned[j.child] * (childRest.x - j.at);
    poses[j.child].q = (turned[j.child] * childRest.q).normalized();
  }
  return poses;
}

Quat driveTarget(const Skeleton& skeleton, int joint, const Quat& turn) {
  const SkeletonJoint& j = skeleton.joints[joint];
  return skeleton.bones[j.parent].rest.q.conjugate() * turn * skeleton.bones[j.child].rest.q;
}

std::vector<Ragdoll> add(World& world, const Skeleton& skeleton, const JointTurns& turns,
                         const RagdollDef& def) {
  const std::vector<Pose> poses = posed(skeleton, turns);
  std::vector<Ragdoll> figures;
  for (const Pose& copy : latticePoses(def.copies, Vec3(1, 2, 1), def.seed)) {
    const Vec3 at = def.place.position + def.place.rotation * copy.x;
    const Quat turn = def.place.rotation * copy.q;
    Figure figure{world, skeleton, def, {}};
    const std::vector<Pose> bones = placed(skeleton, poses, at, turn);
    addBones(figure, bones, bones[0].x);
    for (const SkeletonJoint& joint : skeleton.joints) addJoint(figure, joint);
    for (const auto& [a, b] : skeleton.apart) {
      world.ignoreCollision(figure.out.bones[a], figure.out.bones[b]);
    }
    for (size_t i = 0; def.drive && i < skeleton.joints.size(); ++i) {
      addDrive(figure, skeleton.joints[i], turns[i]);
    }
    figures.push_back(std::move(figure.out));
  }
  return figures;
}

}  // namespace physics
