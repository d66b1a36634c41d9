// Adding bodies and constraints to a World, with every check on what a caller gives.
#include <cmath>

#include "physics/world_impl.h"

namespace physics {
namespace {

bool finite(const Vec3& v) { return v.allFinite(); }

bool isPoint(const Shape& shape) { return std::holds_alternative<PointShape>(shape); }

void checkSettings(const Settings& s) {
  require(std::isfinite(s.dt) && s.dt > 0, "dt must be a positive number of seconds");
  require(s.substeps >= 1, "substeps must be at least 1");
  require(s.iterations >= 1, "iterations must be at least 1");
  require(s.maxIterations >= 0 && s.tolerance >= 0, "iterations and tolerance must be >= 0");
  require(s.relaxation > 0 && s.relaxation < 2, "relaxation must lie between 0 and 2");
  require(s.regularisation >= 0 && std::isfinite(s.regularisation), "regularisation must be >= 0");
  require(!s.gravity || finite(*s.gravity), "gravity must be finite");
}

void checkInertia(const Vec3& inertia) {
  const double x = inertia.x(), y = inertia.y(), z = inertia.z(), slack = 1e-9 * inertia.sum();
  require(finite(inertia) && inertia.minCoeff() >= 0, "inertia must be finite and not negative");
  require(x <= y + z + slack && y <= z + x + slack && z <= x + y + slack,
          "inertia breaks the triangle rule: no moment may exceed the sum of the other two");
}

void checkBody(const BodyDef& def) {
  require(finite(def.pose.x) && def.pose.q.coeffs().allFinite(), "pose must be finite");
  require(def.pose.q.norm() > 1e-6, "orientation must not be the zero quaternion");
  require(finite(def.velocity.v) && finite(def.velocity.w), "velocities must be finite");
  if (def.motion != Motion::kDynamic) return;
  require(std::isfinite(def.mass) && def.mass > 0, "mass must be positive");
  require(!std::holds_alternative<Plane>(def.shape), "a plane cannot move by itself");
  if (def.inertia) checkInertia(*def.inertia);
}

void checkFriction(const Friction& friction) {
  require(friction.staticCoefficient >= friction.dynamicCoefficient &&
              friction.dynamicCoefficient >= 0 && std::isfinite(friction.staticCoefficient),
          "friction needs static >= dynamic >= 0");
}

template <class D>
void checkPair(const World::Impl& w, const D& def) {
  for (const BodyId body : def.bodies) {
    require(body >= 0 && body < w.bodies.size(), "no such body");
  }
  require(def.bodies[0] != def.bodies[1], "a body cannot be joined to itself");
  if constexpr (requires { def.at; }) require(finite(def.at), "a joint's place must be finite");
  if constexpr (requires { def.anchors[0].x(); }) {
    require(finite(def.anchors[0]) && finite(def.anchors[1]), "anchors must be finite");
  } else if constexpr (requires { def.anchors; }) {
    require(!def.anchors || (finite((*def.anchors)[0]) && finite((*def.anchors)[1])),
            "anchors must be finite");
  }
}

void checkOrientation(const Quat& q) {
  require(q.coeffs().allFinite() && q.norm() > 1e-6,
          "an orientation must be a finite quaternion, not zero");
}

template <class C, class D>
int append(World::Impl& w, const D& def, const C& item) {
  int index = -1;
  forEachKind(w.kinds, [&](auto& kind) {
    if constexpr (std::is_same_v<typename std::decay_t<decltype(kind)>::Item, C>) {
      kind.set.items.push_back(item);
      kind.set.lambda.emplace_back();
      kind.set.tuned.push_back({def.tuning.relaxation.value_or(w.settings.relaxation),
                                def.tuning.regularisation.value_or(w.settings.regularisation),
                                w.settings.warmStartJoints && !isForce<C>()});
      index = static_cast<int>(kind.set.items.size()) - 1;
    }
  });
  if constexpr (requires { def.collide; }) {
    if (!def.collide) w.collider.ignore(def.bodies[0], def.bodies[1]);
  }
  return index;
}

Vec3 direction(const Vec3& v) {
  require(finite(v) && v.norm() > 1e-12, "an axis must not be zero");
  return v.normalized();
}

// A world direction in both bodies' frames, or the two that were given in them.
template <class D>
std::array<Vec3, 2> bodyAxes(const World::Impl& w, const D& def) {
  if (def.axes) return {direction((*def.axes)[0]), direction((*def.axes)[1])};
  const Vec3 n = direction(def.axis);
  return {w.bodies.pose[def.bodies[0]].q.conjugate() * n,
          w.bodies.pose[def.bodies[1]].q.conjugate() * n};
}

Vec3 toBody(const Pose& pose, const Vec3& point) { return pose.q.conjugate() * (point - pose.x); }

double startDistance(const World::Impl& w, const std::array<BodyId, 2>& bodies,
                     const std::array<Vec3, 2>& anchors) {
  const Pose &i = w.bodies.pose[bodies[0]], &j = w.bodies.pose[bodies[1]];
  return ((i.x + i.q * anchors[0]) - (j.x + j.q * anchors[1])).norm();
}

Quat relativeOrientation(const World::Impl& w, const std::array<BodyId, 2>& bodies) {
  return w.bodies.pose[bodies[0]].q.conjugate() * w.bodies.pose[bodies[1]].q;
}

}  // namespace

World::World(const Settings& settings) : impl_(std::make_unique<Impl>()) {
  checkSettings(settings);
  if (settings.contact) {
    checkFriction(settings.contact->friction);
    require(settings.contact->restitution >= 0 && settings.contact->restitution <= 1,
            "restitution must lie between 0 and 1");
    require(settings.contact->margin >= 0 && settings.contact->maxSeparationSpeed > 0,
            "contact margin must be >= 0 and its separation speed > 0");
  }
  impl_->settings = settings;
  BodyDef world;
  world.motion = Motion::kStatic;
  add(world);
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

BodyId World::add(const BodyDef& def) {
  Impl& w = *impl_;
  const Friction standard = w.settings.contact ? w.settings.contact->friction : Friction{};
  const Friction friction = def.friction.value_or(standard);
  checkBody(def);
  checkFriction(friction);
  Bodies& b = w.bodies;
  const BodyId id = b.size();
  const bool dynamic = def.motion == Motion::kDynamic;
  const Vec3 inertia =
      dynamic && !isPoint(def.shape)
          ? def.inertia.value_or(def.mass * massProperties(def.shape).inertiaPerMass)
          : Vec3::Zero().eval();
  const Vec3 inverse = inertia.unaryExpr([](double i) { return i > 0 ? 1 / i : 0.0; });
  b.pose.push_back({def.pose.x, def.pose.q.normalized()});
  b.start.push_back(b.pose.back());
  b.velocity.push_back(def.motion == Motion::kStatic ? Velocity{} : def.velocity);
  b.inverse.push_back({dynamic ? 1 / def.mass : 0, inverse.x() * Mat3::Identity()});
  b.inverseInertia.push_back(inverse);
  b.inertia.push_back(inertia);
  b.mass.push_back(dynamic ? def.mass : 0);
  b.motion.push_back(def.motion);
  b.shift.push_back(Vec3::Zero());
  b.correction.emplace_back();
  b.freeTurn.push_back(Vec3::Zero());
  b.shape.push_back(def.shape);
  b.friction.push_back(friction);
  w.loads.emplace_back();
  if (w.settings.contact && id != kWorldBody) {
    w.collider.add(id, def.shape, def.motion != Motion::kStatic);
  }
  return id;
}

int World::add(const BallSocketDef& def) {
  checkPair(*impl_, def);
  const auto& pose = impl_->bodies.pose;
  BallSocket item{def.bodies, {}, def.form};
  for (int k = 0; k < 2; ++k) {
    item.anchors[k] = def.anchors ? (*def.anchors)[k] : toBody(pose[def.bodies[k]], def.at);
  }
  return append(*impl_, def, item);
}

int World::add(const AxleDef& def) {
  checkPair(*impl_, def);
  const std::array<Vec3, 2> axes = bodyAxes(*impl_, def);
  Axle item{def.bodies, axes[0], Mat3::Identity(), def.form};
  const Vec3 u = anyNormalTo(axes[1]);
  item.frameJ << u, axes[1].cross(u), axes[1];
  return append(*impl_, def, item);
}

int World::add(const ConeLimitDef& def) {
  checkPair(*impl_, def);
  require(def.angle >= 0 && def.angle <= kPi, "a cone's angle must lie between 0 and 180 degrees");
  return append(*impl_, def, ConeLimit{def.bodies, bodyAxes(*impl_, def), def.angle});
}

int World::add(const TwistLimitDef& def) {
  checkPair(*impl_, def);
  require(def.range[0] <= def.range[1] && def.range[0] >= -kPi && def.range[1] <= kPi,
          "a twist's limits must be ordered and within 180 degrees");
  const Vec3 n = impl_->bodies.pose[def.bodies[0]].q.conjugate() * direction(def.axis);
  if (def.reference) checkOrientation(*def.reference);
  const Quat reference = def.reference.value_or(relativeOrientation(*impl_, def.bodies));
  return append(*impl_, def,
                TwistLimit{def.bodies, n, reference.normalized(), def.range[0], def.range[1]});
}

int World::add(const DistanceDef& def) {
  checkPair(*impl_, def);
  const double length = def.length.value_or(startDistance(*impl_, def.bodies, def.anchors));
  require(std::isfinite(length) && length >= 0, "a distance must not be negative");
  return append(*impl_, def, Distance{def.bodies, def.anchors, length, def.rope});
}

int World::add(const SpringDef& def) {
  checkPair(*impl_, def);
  require(def.stiffness >= 0 && def.damping >= 0, "stiffness and damping must not be negative");
  const double rest = def.restLength.value_or(startDistance(*impl_, def.bodies, def.anchors));
  require(std::isfinite(rest) && rest >= 0, "a rest length must not be negative");
  return append(*impl_, def, Spring{def.bodies, def.anchors, def.stiffness, def.damping, rest});
}

int World::add(const DriveDef& def) {
  checkPair(*impl_, def);
  require(def.stiffness >= 0 && def.damping >= 0 && def.maxTorque >= 0,
          "a drive's stiffness, damping and torque must not be negative");
  if (def.target) checkOrientation(*def.target);
  const Quat target = def.target.value_or(relativeOrientation(*impl_, def.bodies)).normalized();
  return append(*impl_, def, Drive{def.bodies, target, def.stiffness, def.damping, def.maxTorque});
}

int World::add(const MotorDef& def) {
  checkPair(*impl_, def);
  require(std::isfinite(def.speed) && def.maxTorque >= 0,
          "a motor's speed must be finite and its torque not negative");
  const Vec3 n = impl_->bodies.pose[def.bodies[0]].q.conjugate() * direction(def.axis);
  return append(*impl_, def, Motor{def.bodies, n, def.speed, def.maxTorque});
}

void World::ignoreCollision(BodyId a, BodyId b) { impl_->collider.ignore(a, b); }

}  // namespace physics
