// Bullet with rigid bodies and joints between them, by three of its solvers.
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>

#include "app/peers/bullet_multibody.h"
#include "app/peers/bullet_world.h"
#include "app/peers/engines.h"

namespace app {
namespace {

using physics::Mat3;
using physics::Vec3;
using Kind = PeerJoint::Kind;

enum class Solver { kSequential, kConjugate, kDirect };

class BulletRigid : public BulletPeer {
 public:
  BulletRigid(const physics::World& world, Blueprint plan, Solver solver, int iterations)
      : BulletPeer(world, std::move(plan),
                   std::vector<bool>(static_cast<std::size_t>(world.bodyCount()), false)) {
    makeSolver(solver);
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadPhase_, solver_.get(),
                                                       &configuration_);
    setUp(world_->getSolverInfo(), iterations);
    // A direct solver is better off with islands one by one, says Bullet.
    if (solver == Solver::kDirect) world_->getSolverInfo().m_minimumSolverBatchSize = 1;
    addRigidBodies(*world_);
    for (const PeerJoint& joint : plan_.joints) addJoint(joint);
  }
  ~BulletRigid() override {
    for (const auto& joint : joints_) world_->removeConstraint(joint.get());
    for (const auto& body : rigid_) world_->removeRigidBody(body.get());
  }

  std::int64_t warnings() const override { return direct_ ? direct_->getNumFallbacks() : 0; }

 protected:
  btDiscreteDynamicsWorld& world() const override { return *world_; }

 private:
  void makeSolver(Solver solver) {
    if (solver == Solver::kSequential) {
      solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    } else if (solver == Solver::kConjugate) {
      solver_ = std::make_unique<btNNCGConstraintSolver>();
    } else {
      auto direct = std::make_unique<btMLCPSolver>(&dantzig_);
      direct_ = direct.get();
      solver_ = std::move(direct);
    }
  }

  // The frame of a hinge or a slider in body `side`, both frames parallel at the start. The axis is
  // z of a hinge, x of a slider.
  btTransform frame(const PeerJoint& joint, int side) const {
    const Vec3 n = axisAtStart(plan_, joint, 0), u = physics::anyNormalTo(n);
    Mat3 axes;
    if (joint.kind == Kind::kSlider) {
      axes << n, u, n.cross(u);
    } else {
      axes << u, n.cross(u), n;
    }
    const physics::Quat q =
        plan_.start.pose[joint.bodies[side]].q.conjugate() * physics::Quat(axes);
    return toBullet(physics::Pose{joint.anchors[side], q});
  }

  // Bullet's cone is about x of both frames, its twist as far to either side.
  void addCone(const PeerJoint& joint, const PeerCone& cone) {
    const Vec3 u = physics::anyNormalTo(cone.axis);
    Mat3 axes;
    axes << cone.axis, u, cone.axis.cross(u);
    const physics::Quat first(axes);
    const auto [low, high] = cone.twist;
    const physics::Quat toMiddle = physics::exponential(-(low + high) / 2 * Vec3::UnitX());
    const physics::Quat second = cone.reference.conjugate() * first * toMiddle;
    auto joined =
        std::make_unique<btConeTwistConstraint>(*rigid_[joint.bodies[0]], *rigid_[joint.bodies[1]],
                                                toBullet(physics::Pose{joint.anchors[0], first}),
                                                toBullet(physics::Pose{joint.anchors[1], second}));
    joined->setLimit(cone.angle, cone.angle, (high - low) / 2);
    joints_.push_back(std::move(joined));
  }

  void addJoint(const PeerJoint& joint) {
    btRigidBody &a = *rigid_[joint.bodies[0]], &b = *rigid_[joint.bodies[1]];
    if (a.isStaticOrKinematicObject() && b.isStaticOrKinematicObject()) return;
    if (joint.cone) {
      addCone(joint, *joint.cone);
    } else if (joint.kind == Kind::kBall) {
      joints_.push_back(std::make_unique<btPoint2PointConstraint>(a, b, toBullet(joint.anchors[0]),
                                                                  toBullet(joint.anchors[1])));
    } else if (joint.kind == Kind::kUniversal) {
      btVector3 at = toBullet(anchorAtStart(plan_, joint, 0));
      btVector3 n1 = toBullet(axisAtStart(plan_, joint, 0)),
                n2 = toBullet(axisAtStart(plan_, joint, 1));
      joints_.push_back(std::make_unique<btUniversalConstraint>(a, b, at, n1, n2));
    } else if (joint.kind == Kind::kSlider) {
      joints_.push_back(
          std::make_unique<btSliderConstraint>(a, b, frame(joint, 0), frame(joint, 1), true));
    } else {
      auto hinge = std::make_unique<btHingeConstraint>(a, b, frame(joint, 0), frame(joint, 1));
      // Bullet counts the turn of its first body against its second.
      if (joint.limits) hinge->setLimit(-(*joint.limits)[1], -(*joint.limits)[0]);
      joints_.push_back(std::move(hinge));
    }
    world_->addConstraint(joints_.back().get());
  }

  btDantzigSolver dantzig_;
  std::unique_ptr<btConstraintSolver> solver_;
  btMLCPSolver* direct_ = nullptr;  // solver_, where it is one
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

template <Solver solver>
PeerStart startRigid(const physics::World& world, int iterations) {
  Blueprint plan = makeBlueprint(world);
  if (!plan.refusal.empty()) return {nullptr, plan.refusal};
  for (const PeerJoint& joint : plan.joints) {
    if (joint.kind == Kind::kDistance)
      return {nullptr, "Bullet has no joint that keeps a distance"};
  }
  return {std::make_unique<BulletRigid>(world, std::move(plan), solver, iterations), ""};
}

}  // namespace

PeerOffer bulletOffer() {
  const std::string setup =
      "; ERP 0.2, gyroscopic terms, where something bounces no open contacts and overlaps split "
      "from velocities, "
      "springs as explicit forces";
  const int iterations = btContactSolverInfo().m_numIterations;
  PeerOffer offer{{"Bullet", DBD_BULLET_VERSION ", double precision", "libbullet-dev"}, {}};
  const auto add = [&](const char* name, const char* title, const char* note, int count,
                       auto start) {
    offer.entries.push_back({{name, title, "Bullet", note + setup, count}, start});
  };
  add("bullet", "Bullet, sequential impulses", "projected Gauss-Seidel with warm start", iterations,
      startRigid<Solver::kSequential>);
  add("bullet_nncg", "Bullet, conjugate gradients", "non-smooth non-linear conjugate gradients",
      iterations, startRigid<Solver::kConjugate>);
  add("bullet_dantzig", "Bullet, direct", "one linear complementarity problem by Dantzig's method",
      0, startRigid<Solver::kDirect>);
  add("bullet_multibody", "Bullet, articulated", "joint coordinates, Featherstone's algorithm",
      iterations, startMultibody<false>);
  add("bullet_multibody_rk4", "Bullet, articulated, Runge-Kutta",
      "joint coordinates, Featherstone's algorithm, four evaluations a step", iterations,
      startMultibody<true>);
  return offer;
}

}  // namespace app
