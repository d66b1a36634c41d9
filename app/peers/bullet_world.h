// What Bullet's rigid and articulated peers have in common. Only app/peers/bullet*.cpp include it.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "app/peers/blueprint.h"
#include "app/peers/peer.h"

namespace app {

inline btVector3 toBullet(const physics::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion toBullet(const physics::Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline btTransform toBullet(const physics::Pose& pose) {
  return btTransform(toBullet(pose.q), toBullet(pose.x));
}
inline physics::Vec3 fromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline physics::Quat fromBullet(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

class BulletPeer : public Peer {
 public:
  struct Stepper {  // of one method; the solver outlives the world
    std::unique_ptr<btConstraintSolver> solver;
    std::unique_ptr<btDiscreteDynamicsWorld> world;
  };
  // Makes a rigid body of every body that `isLink` does not hold.
  BulletPeer(const physics::World& world, Blueprint plan, std::vector<bool> isLink);
  ~BulletPeer() override;
  BulletPeer(const BulletPeer&) = delete;
  BulletPeer& operator=(const BulletPeer&) = delete;

  void step(double h) override;
  void read(std::span<physics::Pose> poses, std::span<physics::Velocity> velocities) const override;

 protected:
  // Where it goes and how it touches, for rigid bodies and links.
  void setSurface(btCollisionObject& object, physics::BodyId body);
  btCollisionShape* shapeOf(physics::BodyId body) { return shapes_[body].get(); }
  int maskOf(physics::BodyId body) const;
  void setUp(btContactSolverInfo& info, int iterations) const;
  void addRigidBodies(btDiscreteDynamicsWorld& world);
  virtual void applyLoad(physics::BodyId body, const PeerLoad& load);
  virtual btDiscreteDynamicsWorld& world() const = 0;

  struct Filter : btOverlapFilterCallback {
    const Blueprint* plan = nullptr;
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;
  };
  struct Path : btMotionState {  // of a kinematic body
    btTransform next;
    void getWorldTransform(btTransform& transform) const override { transform = next; }
    void setWorldTransform(const btTransform&) override {}
  };

  Blueprint plan_;
  const physics::Settings settings_;
  const physics::Bodies bodies_;  // as they were at the start
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadPhase_;
  Filter filter_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;  // by BodyId
  std::vector<std::unique_ptr<Path>> paths_;
  std::vector<std::unique_ptr<btRigidBody>> rigid_;  // by BodyId; null: a link

 private:
  void makeRigidBody(physics::BodyId body);
  void applyForces();
  PeerState state_;
};

}  // namespace app
