// ODE: its direct solver and its iterative one. ERP and CFM at their defaults, finite rotations and
// gyroscopic terms on.
#include <cmath>
#include <stdexcept>

#include "app/peers/blueprint.h"
#include "app/peers/engines.h"
#include "app/peers/ode_joints.h"

namespace app {
namespace {

using physics::BodyId;
using physics::Quat;
using physics::Vec3;

const Quat kZToY(std::sqrt(0.5), -std::sqrt(0.5), 0,
                 0);  // ODE's capsules and cylinders lie along z

std::int64_t messages = 0;  // ODE has one handler for all worlds

void countMessage(int, const char*, va_list) { ++messages; }
void giveUp(int, const char* text, va_list) {
  throw std::runtime_error(std::string("ODE gives up: ") + text);
}

struct Library {
  Library() {
    dInitODE2(0);
    dSetMessageHandler(countMessage);
    dSetErrorHandler(giveUp);
    dSetDebugHandler(giveUp);
  }
  ~Library() { dCloseODE(); }
};

void toOde(const Quat& q, dQuaternion out) {
  out[0] = q.w(), out[1] = q.x(), out[2] = q.y(), out[3] = q.z();
}
Vec3 fromOde(const dReal* v) { return {v[0], v[1], v[2]}; }

struct ConvexData {  // ODE keeps pointers to these
  std::vector<dReal> planes, points;
  std::vector<unsigned> polygons;
};

class OdePeer : public Peer {
 public:
  OdePeer(const physics::World& world, Blueprint plan, int iterations)
      : plan_(std::move(plan)), iterations_(iterations), settings_(world.settings()) {
    static const Library library;
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    if (settings_.gravity) {
      dWorldSetGravity(world_, settings_.gravity->x(), settings_.gravity->y(),
                       settings_.gravity->z());
    }
    if (iterations_ > 0) dWorldSetQuickStepNumIterations(world_, iterations_);
    bodies_.assign(plan_.start.pose.size(), nullptr);
    for (BodyId i = 1; i < world.bodyCount(); ++i) {
      addBody(world.bodies(), i);
      if (settings_.contact) addShape(world.bodies(), i);
    }
    for (const PeerJoint& joint : plan_.joints) {
      addOdeJoint(world_, bodies_[joint.bodies[0]], bodies_[joint.bodies[1]], plan_, joint);
    }
  }
  ~OdePeer() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  OdePeer(const OdePeer&) = delete;
  OdePeer& operator=(const OdePeer&) = delete;

  void step(double h) override {
    const std::int64_t before = messages;
    dRandSetSeed(seed_);  // the quick step shuffles its rows
    applyForces();
    dJointGroupEmpty(contacts_);
    bounceSpeed_ = settings_.gravity ? 2 * h * settings_.gravity->norm() : 0;
    if (settings_.contact) dSpaceCollide(space_, this, near);
    if ((iterations_ > 0 ? dWorldQuickStep(world_, h) : dWorldStep(world_, h)) == 0) {
      throw std::runtime_error("ODE gives up: no memory for the step");
    }
    seed_ = dRandGetSeed();
    warnings_ += messages - before;
  }

  void read(std::span<physics::Pose> poses,
            std::span<physics::Velocity> velocities) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      poses[i] = plan_.start.pose[i];
      velocities[i] = plan_.start.velocity[i];
      if (bodies_[i] == nullptr) continue;
      const dReal* q = dBodyGetQuaternion(bodies_[i]);
      poses[i] = {fromOde(dBodyGetPosition(bodies_[i])), Quat(q[0], q[1], q[2], q[3])};
      velocities[i] = {fromOde(dBodyGetLinearVel(bodies_[i])),
                       fromOde(dBodyGetAngularVel(bodies_[i]))};
    }
  }

  std::int64_t warnings() const override { return warnings_; }

 private:
  void addBody(const physics::Bodies& b, BodyId i) {
    friction_.push_back(b.friction[i].dynamicCoefficient);
    if (b.motion[i] == physics::Motion::kStatic) return;
    const dBodyID body = bodies_[i] = dBodyCreate(world_);
    dQuaternion q;
    toOde(b.pose[i].q, q);
    const Vec3 &x = b.pose[i].x, &v = b.velocity[i].v, &w = b.velocity[i].w;
    dBodySetPosition(body, x.x(), x.y(), x.z());
    dBodySetQuaternion(body, q);
    dBodySetLinearVel(body, v.x(), v.y(), v.z());
    dBodySetAngularVel(body, w.x(), w.y(), w.z());
    dBodySetFiniteRotationMode(body, 1);
    if (b.motion[i] == physics::Motion::kKinematic) return dBodySetKinematic(body);
    // Nothing turns a point, so that its inertia is of no account.
    const bool turns = b.inertia[i].minCoeff() > 0;
    const Vec3 inertia = turns ? b.inertia[i] : Vec3::Constant(b.mass[i]);
    dMass mass;
    dMassSetParameters(&mass, b.mass[i], 0, 0, 0, inertia.x(), inertia.y(), inertia.z(), 0, 0, 0);
    dBodySetMass(body, &mass);
  }

  dGeomID geometry(const physics::PointShape&) { return dCreateSphere(space_, kPointRadius); }
  dGeomID geometry(const physics::Box& s) {
    return dCreateBox(space_, s.size.x(), s.size.y(), s.size.z());
  }
  dGeomID geometry(const physics::Sphere& s) { return dCreateSphere(space_, s.radius); }
  dGeomID geometry(const physics::Capsule& s) { return dCreateCapsule(space_, s.radius, s.length); }
  dGeomID geometry(const physics::Cylinder& s) {
    return dCreateCylinder(space_, s.radius, s.length);
  }
  dGeomID geometry(const physics::Convex& s) {
    ConvexData& data = *convex_.emplace_back(std::make_unique<ConvexData>());
    for (const Vec3& p : s.hull->vertices)
      data.points.insert(data.points.end(), p.begin(), p.end());
    for (const physics::Hull::Face& face : s.hull->faces) {
      data.planes.insert(data.planes.end(), face.normal.begin(), face.normal.end());
      data.planes.push_back(face.offset);
      data.polygons.push_back(static_cast<unsigned>(face.vertices.size()));
      data.polygons.insert(data.polygons.end(), face.vertices.begin(), face.vertices.end());
    }
    return dCreateConvex(space_, data.planes.data(), static_cast<unsigned>(s.hull->faces.size()),
                         data.points.data(), static_cast<unsigned>(s.hull->vertices.size()),
                         data.polygons.data());
  }
  dGeomID geometry(const physics::Plane&) { return nullptr; }  // needs the pose
  // Blueprints refuse these.
  dGeomID geometry(const physics::Compound&) { return nullptr; }
  dGeomID geometry(const physics::Triangles&) { return nullptr; }

  void addShape(const physics::Bodies& b, BodyId i) {
    const physics::Pose& pose = b.pose[i];
    if (const auto* plane = std::get_if<physics::Plane>(&b.shape[i])) {
      const Vec3 n = pose.q * plane->normal;
      dGeomSetData(dCreatePlane(space_, n.x(), n.y(), n.z(), plane->offset + n.dot(pose.x)),
                   reinterpret_cast<void*>(std::intptr_t{i}));
      return;
    }
    if (std::holds_alternative<physics::PointShape>(b.shape[i]) && bodies_[i] == nullptr) return;
    const dGeomID geom = std::visit([&](const auto& shape) { return geometry(shape); }, b.shape[i]);
    dGeomSetData(geom, reinterpret_cast<void*>(std::intptr_t{i}));
    const bool alongZ = std::holds_alternative<physics::Capsule>(b.shape[i]) ||
                        std::holds_alternative<physics::Cylinder>(b.shape[i]);
    dQuaternion q;
    if (bodies_[i] != nullptr) {
      dGeomSetBody(geom, bodies_[i]);
      toOde(kZToY, q);
      if (alongZ) dGeomSetOffsetQuaternion(geom, q);
    } else {
      toOde(alongZ ? pose.q * kZToY : pose.q, q);
      dGeomSetPosition(geom, pose.x.x(), pose.x.y(), pose.x.z());
      dGeomSetQuaternion(geom, q);
    }
  }

  void applyForces() {
    if (plan_.forces.empty()) return;
    state_.pose.resize(bodies_.size());
    state_.velocity.resize(bodies_.size());
    read(state_.pose, state_.velocity);
    const std::vector<PeerLoad>& loads = plan_.forces.evaluate(state_);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i] == nullptr || dBodyIsKinematic(bodies_[i])) continue;
      const Vec3 &f = loads[i].force, &t = loads[i].torque;
      dBodyAddForce(bodies_[i], f.x(), f.y(), f.z());
      dBodyAddTorque(bodies_[i], t.x(), t.y(), t.z());
    }
  }

  bool movable(BodyId i) const { return bodies_[i] != nullptr && !dBodyIsKinematic(bodies_[i]); }

  Vec3 speedAt(BodyId i, const dVector3& p) const {
    dVector3 v = {0, 0, 0, 0};
    if (bodies_[i] != nullptr) dBodyGetPointVel(bodies_[i], p[0], p[1], p[2], v);
    return fromOde(v);
  }

  // ODE's friction is a pyramid, which is right along its first axis: so that goes along the slip.
  void turnPyramid(dContact& contact, BodyId a, BodyId b) const {
    constexpr double kSlips = 0.01;  // m/s: at rest there is no slip to go by
    const Vec3 n = fromOde(contact.geom.normal);
    const Vec3 v = speedAt(a, contact.geom.pos) - speedAt(b, contact.geom.pos);
    const Vec3 slip = v - v.dot(n) * n;
    if (slip.norm() < kSlips) return;
    contact.surface.mode |= dContactFDir1;
    for (int k = 0; k < 3; ++k) contact.fdir1[k] = slip[k] / slip.norm();
  }

  static void near(void* self, dGeomID ga, dGeomID gb) {
    static_cast<OdePeer*>(self)->touch(ga, gb);
  }
  void touch(dGeomID ga, dGeomID gb) {
    constexpr int kMostContacts = 8;
    const auto a = static_cast<BodyId>(reinterpret_cast<std::intptr_t>(dGeomGetData(ga)));
    const auto b = static_cast<BodyId>(reinterpret_cast<std::intptr_t>(dGeomGetData(gb)));
    if ((!movable(a) && !movable(b)) || plan_.ignores(a, b)) return;
    std::array<dContact, kMostContacts> contacts;
    const int count = dCollide(ga, gb, kMostContacts, &contacts[0].geom, sizeof(dContact));
    for (int k = 0; k < count; ++k) {
      dSurfaceParameters& surface = contacts[k].surface;
      surface = {};
      surface.mode = dContactApprox1 | dContactBounce;
      surface.mu = std::sqrt(friction_[a - 1] * friction_[b - 1]);
      surface.bounce = settings_.contact->restitution;
      surface.bounce_vel = bounceSpeed_;
      turnPyramid(contacts[k], a, b);
      dJointAttach(dJointCreateContact(world_, contacts_, &contacts[k]), bodies_[a], bodies_[b]);
    }
  }

  Blueprint plan_;
  int iterations_;
  physics::Settings settings_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID contacts_ = nullptr;
  std::vector<dBodyID> bodies_;   // by BodyId; null: static
  std::vector<double> friction_;  // by BodyId - 1
  std::vector<std::unique_ptr<ConvexData>> convex_;
  PeerState state_;
  double bounceSpeed_ = 0;
  unsigned long seed_ = 0;
  std::int64_t warnings_ = 0;
};

PeerStart startOde(const physics::World& world, int iterations) {
  Blueprint plan = makeBlueprint(world);
  if (!plan.refusal.empty()) return {nullptr, plan.refusal};
  if (plan.hasCones()) return {nullptr, "ODE has no cone_limit"};
  return {std::make_unique<OdePeer>(world, std::move(plan), iterations), ""};
}

}  // namespace

PeerOffer odeOffer() {
  const std::string setup =
      "; ERP and CFM at their defaults, finite rotations, contacts with the friction pyramid "
      "along their slip, springs as explicit forces";
  PeerMethod direct{"ode", "ODE, direct", "ODE",
                    "dWorldStep: one linear complementarity problem" + setup, 0};
  PeerMethod quick{"ode_quick", "ODE, iterative", "ODE", "dWorldQuickStep: projected SOR" + setup,
                   20};
  return {{"ODE", DBD_ODE_VERSION ", double precision", "libode-dev"},
          {{direct, startOde}, {quick, startOde}}};
}

}  // namespace app
