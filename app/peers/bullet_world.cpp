// Bullet's shapes and rigid bodies. ERP and slop at their defaults, gyroscopic terms on, no
// damping. Where something bounces, open contacts are left out and overlaps are split from
// velocities: at the defaults a ball loses or gains most of its energy within a few bounces.
#include "app/peers/bullet_world.h"

#include <cmath>

#include "physics/base/rotation.h"

namespace app {
namespace {

using physics::BodyId;
using physics::Vec3;

constexpr double kHullMargin = 1e-3;  // m: Bullet's own of 4 cm lies outside of a hull

struct ShapeMaker {
  using Made = std::unique_ptr<btCollisionShape>;
  Made operator()(const physics::PointShape&) const {
    return std::make_unique<btSphereShape>(kPointRadius);
  }
  Made operator()(const physics::Box& s) const {
    return std::make_unique<btBoxShape>(toBullet(s.size / 2));
  }
  Made operator()(const physics::Sphere& s) const {
    return std::make_unique<btSphereShape>(s.radius);
  }
  Made operator()(const physics::Capsule& s) const {
    return std::make_unique<btCapsuleShape>(s.radius, s.length);
  }
  Made operator()(const physics::Cylinder& s) const {
    return std::make_unique<btCylinderShape>(btVector3(s.radius, s.length / 2, s.radius));
  }
  Made operator()(const physics::Convex& s) const {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& p : s.hull->vertices) hull->addPoint(toBullet(p), false);
    hull->recalcLocalAabb();
    hull->setMargin(kHullMargin);
    return hull;
  }
  Made operator()(const physics::Plane& s) const {
    return std::make_unique<btStaticPlaneShape>(toBullet(s.normal), s.offset);
  }
  // Blueprints refuse these.
  Made operator()(const physics::Compound&) const { return nullptr; }
  Made operator()(const physics::Triangles&) const { return nullptr; }
};

}  // namespace

bool BulletPeer::Filter::needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const {
  const auto* one = static_cast<const btCollisionObject*>(a->m_clientObject);
  const auto* other = static_cast<const btCollisionObject*>(b->m_clientObject);
  return (a->m_collisionFilterGroup & b->m_collisionFilterMask) != 0 &&
         (b->m_collisionFilterGroup & a->m_collisionFilterMask) != 0 &&
         !plan->ignores(one->getUserIndex(), other->getUserIndex());
}

BulletPeer::BulletPeer(const physics::World& world, Blueprint plan, std::vector<bool> isLink)
    : plan_(std::move(plan)), settings_(world.settings()), bodies_(world.bodies()) {
  filter_.plan = &plan_;
  broadPhase_.getOverlappingPairCache()->setOverlapFilterCallback(&filter_);
  for (BodyId i = 0; i < bodies_.size(); ++i) {
    shapes_.push_back(std::visit(ShapeMaker{}, bodies_.shape[i]));
    rigid_.emplace_back();
    paths_.emplace_back();
    if (!isLink[i]) makeRigidBody(i);
  }
}

BulletPeer::~BulletPeer() = default;

void BulletPeer::makeRigidBody(BodyId i) {
  const bool movable = bodies_.motion[i] == physics::Motion::kDynamic;
  btRigidBody::btRigidBodyConstructionInfo info(movable ? bodies_.mass[i] : 0, nullptr,
                                                shapes_[i].get(), toBullet(bodies_.inertia[i]));
  info.m_startWorldTransform = toBullet(bodies_.pose[i]);
  rigid_[i] = std::make_unique<btRigidBody>(info);
  btRigidBody& body = *rigid_[i];
  body.setLinearVelocity(toBullet(bodies_.velocity[i].v));
  body.setAngularVelocity(toBullet(bodies_.velocity[i].w));
  body.setFlags(bodies_.inertia[i].minCoeff() > 0 ? BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY : 0);
  setSurface(body, i);
  if (bodies_.motion[i] != physics::Motion::kKinematic) return;
  paths_[i] = std::make_unique<Path>();
  paths_[i]->next = info.m_startWorldTransform;
  body.setMotionState(paths_[i].get());
  body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
}

void BulletPeer::setSurface(btCollisionObject& object, BodyId i) {
  object.setUserIndex(i);
  object.setActivationState(DISABLE_DEACTIVATION);
  // Bullet multiplies the two of a pair: so that friction is their geometric mean, as ours.
  object.setFriction(std::sqrt(bodies_.friction[i].dynamicCoefficient));
  if (!settings_.contact || settings_.contact->restitution == 0) return;
  object.setRestitution(std::sqrt(settings_.contact->restitution));
  // By default a contact that is still open takes gap / h from the speed of the bounce.
  object.setContactProcessingThreshold(0);
}

int BulletPeer::maskOf(BodyId i) const {
  const bool point = std::holds_alternative<physics::PointShape>(bodies_.shape[i]);
  if (!settings_.contact || (point && bodies_.motion[i] != physics::Motion::kDynamic)) return 0;
  // Points are a group of their own, so that they do not touch each other.
  return point ? btBroadphaseProxy::AllFilter & ~btBroadphaseProxy::DebrisFilter
               : btBroadphaseProxy::AllFilter;
}

void BulletPeer::setUp(btContactSolverInfo& info, int iterations) const {
  if (iterations > 0) info.m_numIterations = iterations;
  // By default an overlap below 4 cm becomes velocity, and what bounces gains energy.
  if (settings_.contact && settings_.contact->restitution > 0) {
    info.m_splitImpulsePenetrationThreshold = 0;
  }
}

void BulletPeer::addRigidBodies(btDiscreteDynamicsWorld& world) {
  world.setGravity(toBullet(settings_.gravity.value_or(Vec3::Zero())));
  for (BodyId i = 1; i < bodies_.size(); ++i) {
    if (!rigid_[i]) continue;
    const bool point = std::holds_alternative<physics::PointShape>(bodies_.shape[i]);
    world.addRigidBody(rigid_[i].get(),
                       point ? btBroadphaseProxy::DebrisFilter : btBroadphaseProxy::DefaultFilter,
                       maskOf(i));
  }
}

void BulletPeer::applyLoad(BodyId i, const PeerLoad& load) {
  rigid_[i]->applyCentralForce(toBullet(load.force));
  rigid_[i]->applyTorque(toBullet(load.torque));
}

void BulletPeer::applyForces() {
  if (plan_.forces.empty()) return;
  state_.pose.resize(shapes_.size());
  state_.velocity.resize(shapes_.size());
  read(state_.pose, state_.velocity);
  const std::vector<PeerLoad>& loads = plan_.forces.evaluate(state_);
  for (BodyId i = 1; i < bodies_.size(); ++i) {
    if (bodies_.motion[i] == physics::Motion::kDynamic) applyLoad(i, loads[i]);
  }
}

void BulletPeer::step(double h) {
  applyForces();
  for (BodyId i = 1; i < bodies_.size(); ++i) {
    if (!paths_[i]) continue;
    physics::Pose pose{fromBullet(paths_[i]->next.getOrigin()),
                       fromBullet(paths_[i]->next.getRotation())};
    const physics::Velocity& velocity = bodies_.velocity[i];
    physics::displace(pose, h * velocity.v, h * velocity.w);
    paths_[i]->next = toBullet(pose);
  }
  world().stepSimulation(h, 0);
}

void BulletPeer::read(std::span<physics::Pose> poses,
                      std::span<physics::Velocity> velocities) const {
  for (std::size_t i = 0; i < rigid_.size(); ++i) {
    poses[i] = plan_.start.pose[i];
    velocities[i] = plan_.start.velocity[i];
    if (!rigid_[i] || rigid_[i]->isStaticObject()) continue;
    const btTransform& at = rigid_[i]->getWorldTransform();
    poses[i] = {fromBullet(at.getOrigin()), fromBullet(at.getRotation())};
    if (paths_[i]) continue;
    velocities[i] = {fromBullet(rigid_[i]->getLinearVelocity()),
                     fromBullet(rigid_[i]->getAngularVelocity())};
  }
}

}  // namespace app
