// Bullet's articulated bodies: trees in joint coordinates by Featherstone's algorithm, rigid bodies
// beside them. Its damping is switched off, and its limit of the coordinates' speed is lifted.
#include "app/peers/bullet_multibody.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>

#include "app/peers/bullet_world.h"
#include "app/peers/tree.h"

namespace app {
namespace {

using physics::BodyId;
using physics::Vec3;
using Kind = PeerJoint::Kind;

constexpr double kNoLimit = 1e12;  // of a coordinate's speed

struct Place {  // of a body in its tree
  int tree = -1, link = -1;
};

class BulletTree : public BulletPeer {
 public:
  BulletTree(const physics::World& world, Blueprint plan, const Forest& forest,
             std::vector<bool> isLink, int iterations, bool isRungeKutta)
      : BulletPeer(world, std::move(plan), std::move(isLink)),
        world_(&dispatcher_, &broadPhase_, &solver_, &configuration_),
        places_(static_cast<std::size_t>(world.bodyCount())) {
    setUp(world_.getSolverInfo(), iterations);
    addRigidBodies(world_);
    for (const Tree& tree : forest.trees) addTree(tree, isRungeKutta);
  }
  ~BulletTree() override {
    for (const auto& limit : limits_) world_.removeMultiBodyConstraint(limit.get());
    for (const auto& collider : colliders_) world_.removeCollisionObject(collider.get());
    for (const auto& tree : trees_) world_.removeMultiBody(tree.get());
    for (const auto& body : rigid_) {
      if (body) world_.removeRigidBody(body.get());
    }
  }

  void read(std::span<physics::Pose> poses,
            std::span<physics::Velocity> velocities) const override {
    BulletPeer::read(poses, velocities);
    for (const auto& tree : trees_) tree->forwardKinematics(rotations_, origins_);
    for (std::size_t k = 0; k < trees_.size(); ++k) {
      omega_.resize(trees_[k]->getNumLinks() + 1);
      speed_.resize(trees_[k]->getNumLinks() + 1);
      trees_[k]->compTreeLinkVelocities(&omega_[0], &speed_[0]);
      for (BodyId i = 1; i < bodies_.size(); ++i) {
        if (places_[i].tree == static_cast<int>(k)) readBody(i, poses[i], velocities[i]);
      }
    }
  }

 protected:
  btDiscreteDynamicsWorld& world() const override { return world_; }

  void applyLoad(BodyId i, const PeerLoad& load) override {
    if (places_[i].tree < 0) return BulletPeer::applyLoad(i, load);
    btMultiBody& tree = *trees_[places_[i].tree];
    if (places_[i].link < 0) {
      tree.addBaseForce(toBullet(load.force));
      tree.addBaseTorque(toBullet(load.torque));
    } else {
      tree.addLinkForce(places_[i].link, toBullet(load.force));
      tree.addLinkTorque(places_[i].link, toBullet(load.torque));
    }
  }

 private:
  bool isPointBody(BodyId i) const {
    return std::holds_alternative<physics::PointShape>(bodies_.shape[i]);
  }

  void readBody(BodyId i, physics::Pose& pose, physics::Velocity& velocity) const {
    const btMultiBody& tree = *trees_[places_[i].tree];
    const int link = places_[i].link;
    const btTransform at =
        link < 0 ? tree.getBaseWorldTransform() : tree.getLink(link).m_cachedWorldTransform;
    pose.x = fromBullet(at.getOrigin());
    velocity.v = fromBullet(at.getBasis() * speed_[link + 1]);
    if (isPointBody(i)) return;
    pose.q = fromBullet(at.getRotation());
    velocity.w = fromBullet(at.getBasis() * omega_[link + 1]);
  }

  void addTree(const Tree& tree, bool isRungeKutta) {
    const int count = static_cast<int>(tree.links.size());
    const BodyId base = tree.base;
    trees_.push_back(std::make_unique<btMultiBody>(count, tree.isFixed ? 0 : bodies_.mass[base],
                                                   toBullet(bodies_.inertia[base]), tree.isFixed,
                                                   false));
    btMultiBody& body = *trees_.back();
    body.setBaseWorldTransform(toBullet(bodies_.pose[base]));
    body.setLinearDamping(0);
    body.setAngularDamping(0);
    body.setMaxCoordinateVelocity(kNoLimit);
    body.useRK4Integration(isRungeKutta);
    for (int k = 0; k < count; ++k) addLink(body, tree, k);
    body.finalizeMultiDof();
    if (!tree.isFixed) {
      places_[base] = {static_cast<int>(trees_.size()) - 1, -1};
      body.setBaseVel(toBullet(bodies_.velocity[base].v));
      body.setBaseOmega(toBullet(bodies_.velocity[base].w));
    }
    for (int k = 0; k < count; ++k) setVelocity(body, tree, k);
    world_.addMultiBody(&body);
    const bool limited = std::any_of(tree.links.begin(), tree.links.end(),
                                     [](const TreeLink& k) { return k.joint->limits.has_value(); });
    if (!settings_.contact && !limited) return;
    // Where nothing touches, they are there for the limits: Bullet finds those by their colliders.
    if (!tree.isFixed) addCollider(body, base, -1);
    for (int k = 0; k < count; ++k) addCollider(body, tree.links[k].body, k);
    for (int k = 0; k < count; ++k) addLimits(body, tree.links[k], k);
  }

  void addLink(btMultiBody& body, const Tree& tree, int k) {
    const TreeLink& link = tree.links[k];
    const BodyId i = link.body;
    places_[i] = {static_cast<int>(trees_.size()) - 1, k};
    const physics::Pose &pose = bodies_.pose[i], &parent = bodies_.pose[link.parentBody];
    const btQuaternion turn = toBullet(pose.q.conjugate() * parent.q);
    const btVector3 inertia = toBullet(bodies_.inertia[i]);
    const btVector3 pivot = toBullet(link.joint->anchors[1 - link.side]);
    const btVector3 toCentre = toBullet(-link.joint->anchors[link.side]);
    if (link.joint->kind == Kind::kBall) {
      body.setupSpherical(k, bodies_.mass[i], inertia, link.parent, turn, pivot, toCentre);
    } else if (link.joint->kind == Kind::kHinge) {
      body.setupRevolute(k, bodies_.mass[i], inertia, link.parent, turn,
                         toBullet(link.joint->axes[link.side]), pivot, toCentre);
    } else if (link.joint->kind == Kind::kSlider) {
      const Vec3 slid = pose.x - anchorAtStart(plan_, *link.joint, 1 - link.side);
      body.setupPrismatic(k, bodies_.mass[i], inertia, link.parent, turn,
                          toBullet(link.joint->axes[link.side]), pivot,
                          toBullet(pose.q.conjugate() * slid), false);
    } else {  // a point on a rod
      const Vec3 rod = pose.x - anchorAtStart(plan_, *link.joint, 1 - link.side);
      body.setupRevolute(k, bodies_.mass[i], inertia, link.parent, turn,
                         toBullet(pose.q.conjugate() * *tree.plane), pivot,
                         toBullet(pose.q.conjugate() * rod));
    }
  }

  // The angular velocity of a link's frame at the start: of a rod, that of its point about the
  // other end.
  Vec3 omega(const Tree& tree, int k) const {
    if (k < 0) return tree.isFixed ? Vec3::Zero() : bodies_.velocity[tree.base].w;
    const TreeLink& link = tree.links[k];
    if (link.joint->kind != Kind::kDistance) return bodies_.velocity[link.body].w;
    const Vec3 rod = bodies_.pose[link.body].x - anchorAtStart(plan_, *link.joint, 1 - link.side);
    const Vec3 slip = bodies_.velocity[link.body].v - bodies_.velocity[link.parentBody].v;
    return rod.cross(slip) / rod.squaredNorm();
  }

  double slideSpeed(const TreeLink& link) const {
    const physics::Velocity& parent = bodies_.velocity[link.parentBody];
    const Vec3 arm = bodies_.pose[link.body].x - bodies_.pose[link.parentBody].x;
    const Vec3 n = axisAtStart(plan_, *link.joint, link.side);
    return n.dot(bodies_.velocity[link.body].v - parent.v - parent.w.cross(arm));
  }

  void setVelocity(btMultiBody& body, const Tree& tree, int k) {
    const TreeLink& link = tree.links[k];
    const Vec3 relative =
        bodies_.pose[link.body].q.conjugate() * (omega(tree, k) - omega(tree, link.parent));
    if (link.joint->kind == Kind::kBall) {
      body.setJointVelMultiDof(k, relative.data());
    } else if (link.joint->kind == Kind::kSlider) {
      body.setJointVel(k, slideSpeed(link));
    } else {
      const btVector3& axis = body.getLink(k).getAxisTop(0);
      body.setJointVel(k, fromBullet(axis).dot(relative));
    }
  }

  void addCollider(btMultiBody& body, BodyId i, int link) {
    auto collider = std::make_unique<btMultiBodyLinkCollider>(&body, link);
    collider->setCollisionShape(shapeOf(i));
    collider->setWorldTransform(toBullet(bodies_.pose[i]));
    setSurface(*collider, i);
    world_.addCollisionObject(
        collider.get(),
        isPointBody(i) ? btBroadphaseProxy::DebrisFilter : btBroadphaseProxy::DefaultFilter,
        maskOf(i));
    (link < 0 ? body.setBaseCollider(collider.get())
              : static_cast<void>(body.getLink(link).m_collider = collider.get()));
    colliders_.push_back(std::move(collider));
  }

  void addLimits(btMultiBody& body, const TreeLink& link, int k) {
    if (!link.joint->limits) return;
    const auto [low, high] = *link.joint->limits;
    const bool second = link.side == 1;  // the turn that is limited is that of the second body
    limits_.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(
        &body, k, second ? low : -high, second ? high : -low));
    world_.addMultiBodyConstraint(limits_.back().get());
  }

  btMultiBodyConstraintSolver solver_;
  mutable btMultiBodyDynamicsWorld world_;
  std::vector<Place> places_;  // by BodyId
  std::vector<std::unique_ptr<btMultiBody>> trees_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> limits_;
  mutable btAlignedObjectArray<btQuaternion> rotations_;
  mutable btAlignedObjectArray<btVector3> origins_, omega_, speed_;
};

}  // namespace

template <bool isRungeKutta>
PeerStart startMultibody(const physics::World& world, int iterations) {
  Blueprint plan = makeBlueprint(world);
  if (!plan.refusal.empty()) return {nullptr, plan.refusal};
  if (plan.hasCones()) return {nullptr, "Bullet's articulated bodies have no cone_limit"};
  const Forest forest = findTrees(world, plan);
  if (!forest.refusal.empty()) return {nullptr, forest.refusal};
  if (forest.trees.empty()) return {nullptr, "nothing is articulated: the same as bullet"};
  std::vector<bool> isLink(static_cast<std::size_t>(world.bodyCount()), false);
  for (const Tree& tree : forest.trees) {
    if (!tree.isFixed) isLink[tree.base] = true;
    for (const TreeLink& link : tree.links) isLink[link.body] = true;
  }
  auto peer = std::make_unique<BulletTree>(world, plan, forest, std::move(isLink), iterations,
                                           isRungeKutta);
  if (!startsAsGiven(*peer, world.bodies())) {
    return {nullptr, "a joint opens at the start, which joint coordinates cannot express"};
  }
  return {std::move(peer), ""};
}

template PeerStart startMultibody<false>(const physics::World&, int);
template PeerStart startMultibody<true>(const physics::World&, int);

}  // namespace app
