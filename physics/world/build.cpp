// Making a World and adding bodies to it, with every check on what a caller gives.
#include <algorithm>
#include <cmath>

#include "physics/world/impl.h"

namespace physics {
namespace {

bool isPoint(const Shape& shape) { return std::holds_alternative<PointShape>(shape); }

void checkSettings(const Settings& s) {
  require(std::isfinite(s.dt) && s.dt > 0, "dt must be a positive number of seconds");
  require(s.substepCount() >= 1, "substeps must be at least 1");
  require(!s.accuracy || (*s.accuracy > 0 && *s.accuracy <= 0.5),
          "accuracy must lie between 0 and 0.5");
  require(s.iterations >= 1, "iterations must be at least 1");
  require(s.relaxation > 0 && s.relaxation < 2, "relaxation must lie between 0 and 2");
  require(s.regularisation >= 0 && std::isfinite(s.regularisation), "regularisation must be >= 0");
  require(!s.maxCorrectionSpeed || *s.maxCorrectionSpeed > 0, "max_correction_speed must be > 0");
  require(!s.gravity || s.gravity->allFinite(), "gravity must be finite");
}

void checkInertia(const Vec3& inertia) {
  const double x = inertia.x(), y = inertia.y(), z = inertia.z(), slack = 1e-9 * inertia.sum();
  require(inertia.allFinite() && inertia.minCoeff() >= 0,
          "inertia must be finite and not negative");
  require(x <= y + z + slack && y <= z + x + slack && z <= x + y + slack,
          "inertia breaks the triangle rule: no moment may exceed the sum of the other two");
}

void checkBody(const BodyDef& def) {
  require(def.pose.x.allFinite() && def.pose.q.coeffs().allFinite(), "pose must be finite");
  require(def.pose.q.norm() > 1e-6, "orientation must not be the zero quaternion");
  require(def.velocity.v.allFinite() && def.velocity.w.allFinite(), "velocities must be finite");
  if (def.motion != Motion::kDynamic) return;
  require(std::isfinite(def.mass) && def.mass > 0, "mass must be positive");
  require(!std::holds_alternative<Plane>(def.shape), "a plane cannot move by itself");
  require(!std::holds_alternative<Triangles>(def.shape), "triangles cannot move by themselves");
  if (def.inertia) checkInertia(*def.inertia);
}

void checkFriction(const Friction& friction) {
  require(friction.staticCoefficient >= friction.dynamicCoefficient &&
              friction.dynamicCoefficient >= 0 && std::isfinite(friction.staticCoefficient),
          "friction needs static >= dynamic >= 0");
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
  if (settings.sleep) {
    require(settings.sleep->speed >= 0 && std::isfinite(settings.sleep->speed) &&
                settings.sleep->time > 0 && std::isfinite(settings.sleep->time),
            "sleep needs a speed >= 0 and a time > 0");
  }
  require(settings.localTolerance > 0, "the tolerance of local substeps must be > 0");
  impl_->settings = settings;
  impl_->substeps = settings.substepCount();
  impl_->bodies.general = !settings.leavesOut;
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
  const double restitution =
      def.restitution.value_or(w.settings.contact ? w.settings.contact->restitution : 0);
  require(restitution >= 0 && restitution <= 1, "restitution must lie between 0 and 1");
  require(def.substeps >= 1, "a body's substeps must be at least 1");
  Bodies& b = w.bodies;
  const BodyId id = b.size();
  const bool dynamic = def.motion == Motion::kDynamic;
  const Vec3 inertia =
      dynamic && (def.inertia || !isPoint(def.shape))
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
  b.freeTurn.push_back(Vec3::Zero());
  b.shape.push_back(def.shape);
  b.friction.push_back(friction);
  b.restitution.push_back(restitution);
  b.mostRestitution = std::max(b.mostRestitution, restitution);
  if (def.motion != Motion::kStatic) b.active.push_back(id);
  w.turning += !inverse.isZero(0);
  if (inverse.x() != inverse.y() || inverse.y() != inverse.z()) b.anisotropic.push_back(id);
  w.loads.emplace_back();
  w.last.pose.push_back(b.pose.back());
  w.last.velocity.push_back(b.velocity.back());
  w.ahead.push_back(b.pose.back());
  w.joined.clear();
  w.attached.clear();
  if (w.settings.localSubsteps) w.local.asked.push_back(def.substeps);
  b.isSoft.push_back(false);
  return id;
}

void World::add(const SoftSurfaceDef& def) {
  Impl& w = *impl_;
  require(std::isfinite(def.radius) && def.radius >= 0, "a soft surface's radius must be >= 0");
  checkFriction(def.friction);
  const auto add = [&](BodyId from, BodyId to) {
    for (const BodyId body : {from, to}) {
      require(body > 0 && body < w.bodies.size(), "no such body");
      require(isPoint(w.bodies.shape[body]), "a soft surface is made of points");
    }
    w.softCollider.addElement({from, to, def.radius, def.friction});
    w.bodies.isSoft[from] = w.bodies.isSoft[to] = true;
  };
  for (const BodyId node : def.nodes) add(node, node);
  for (const auto& [from, to] : def.links) add(from, to);
}

void World::ignoreCollision(BodyId a, BodyId b) { impl_->ignore(a, b); }

}  // namespace physics
