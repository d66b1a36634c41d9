// Adding constraints and forces to a World, with every check on what a caller gives.
#include <algorithm>
#include <cmath>

#include "physics/world/impl.h"

namespace physics {
namespace {

bool finite(const Vec3& v) { return v.allFinite(); }

template <class D>
void checkBodies(const WorldState& w, const D& def) {
  auto bodies = def.bodies;
  std::sort(bodies.begin(), bodies.end());
  require(bodies.front() >= 0 && bodies.back() < w.bodies.size(), "no such body");
  require(std::adjacent_find(bodies.begin(), bodies.end()) == bodies.end(),
          "a body cannot be joined to itself");
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
int append(WorldState& w, const D& def, const C& item) {
  w.joined.clear();
  w.attached.clear();
  w.small.topologyChanged();
  Set<C>& set = std::get<Kind<D, C>>(w.kinds).set;
  const int index = static_cast<int>(set.items.size());
  set.active.push_back(index);
  set.items.push_back(item);
  if constexpr (requires { item.factor; }) {
    if (item.factor.table) set.overTime.push_back(index);
  }
  set.lambda.emplace_back();
  set.tuned.push_back({def.tuning.relaxation.value_or(w.settings.relaxation),
                       def.tuning.regularisation.value_or(w.settings.regularisation),
                       w.settings.regularisationForm == Regularisation::kDamping});
  if constexpr (requires { def.collide; }) {
    if (!def.collide) w.ignore(def.bodies[0], def.bodies[1]);
  }
  return index;
}

Vec3 direction(const Vec3& v) {
  require(finite(v) && v.norm() > 1e-12, "an axis must not be zero");
  return v.normalized();
}

// A world direction in both bodies' frames, or the two that were given in them.
template <class D>
std::array<Vec3, 2> bodyAxes(const WorldState& w, const D& def) {
  if (def.axes) return {direction((*def.axes)[0]), direction((*def.axes)[1])};
  const Vec3 n = direction(def.axis);
  return {w.bodies.pose[def.bodies[0]].q.conjugate() * n,
          w.bodies.pose[def.bodies[1]].q.conjugate() * n};
}

Vec3 toBody(const Pose& pose, const Vec3& point) { return pose.q.conjugate() * (point - pose.x); }

// A world point in both bodies' frames, or the two that were given in them.
template <class D>
std::array<Vec3, 2> bodyAnchors(const WorldState& w, const D& def) {
  if (def.anchors) return *def.anchors;
  const auto& pose = w.bodies.pose;
  return {toBody(pose[def.bodies[0]], def.at), toBody(pose[def.bodies[1]], def.at)};
}

// A world direction in a body's frame.
Vec3 bodyAxis(const WorldState& w, BodyId body, const Vec3& n) {
  return w.bodies.pose[body].q.conjugate() * direction(n);
}

// Columns u, v, n with n in the frame of a body.
Mat3 frameAbout(const Vec3& n) {
  const Vec3 u = anyNormalTo(n);
  Mat3 frame;
  frame << u, n.cross(u), n;
  return frame;
}

void checkForce(std::initializer_list<double> parameters, const char* expectation) {
  for (const double p : parameters) require(p >= 0 && std::isfinite(p), expectation);
}

Factor factorOf(const std::optional<OverTime>& table) {
  if (!table) return {};
  check(*table);
  return {std::make_shared<OverTime>(*table), valueAt(*table, 0)};
}

double startDistance(const WorldState& w, const std::array<BodyId, 2>& bodies,
                     const std::array<Vec3, 2>& anchors) {
  const Pose &i = w.bodies.pose[bodies[0]], &j = w.bodies.pose[bodies[1]];
  return ((i.x + i.q * anchors[0]) - (j.x + j.q * anchors[1])).norm();
}

template <class D>
double restLength(const WorldState& w, const D& def) {
  const double rest = def.restLength.value_or(startDistance(w, def.bodies, def.anchors));
  require(std::isfinite(rest) && rest >= 0, "a rest length must not be negative");
  return rest;
}

// The way along the bodies' centres at the start.
double startWay(const WorldState& w, std::span<const BodyId> bodies) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < bodies.size(); ++i) {
    sum += (w.bodies.pose[bodies[i]].x - w.bodies.pose[bodies[i + 1]].x).norm();
  }
  return sum;
}

Quat relativeOrientation(const WorldState& w, const std::array<BodyId, 2>& bodies) {
  return w.bodies.pose[bodies[0]].q.conjugate() * w.bodies.pose[bodies[1]].q;
}

}  // namespace

int World::add(const BallSocketDef& def) {
  checkBodies(*impl_, def);
  return append(*impl_, def, BallSocket{def.bodies, bodyAnchors(*impl_, def), def.form});
}

int World::add(const AxleDef& def) {
  checkBodies(*impl_, def);
  const std::array<Vec3, 2> axes = bodyAxes(*impl_, def);
  return append(*impl_, def, Axle{def.bodies, axes[0], frameAbout(axes[1]), def.form});
}

int World::add(const ConeLimitDef& def) {
  checkBodies(*impl_, def);
  require(def.angle >= 0 && def.angle <= kPi, "a cone's angle must lie between 0 and 180 degrees");
  return append(*impl_, def, ConeLimit{def.bodies, bodyAxes(*impl_, def), def.angle});
}

int World::add(const TwistLimitDef& def) {
  checkBodies(*impl_, def);
  require(def.range[0] <= def.range[1] && def.range[0] >= -kPi && def.range[1] <= kPi,
          "a twist's limits must be ordered and within 180 degrees");
  const Vec3 n = impl_->bodies.pose[def.bodies[0]].q.conjugate() * direction(def.axis);
  if (def.reference) checkOrientation(*def.reference);
  const Quat reference = def.reference.value_or(relativeOrientation(*impl_, def.bodies));
  return append(*impl_, def,
                TwistLimit{def.bodies, n, reference.normalized(), def.range[0], def.range[1]});
}

int World::add(const PointOnLineDef& def) {
  checkBodies(*impl_, def);
  const Mat3 frame = frameAbout(bodyAxis(*impl_, def.bodies[0], def.axis));
  return append(*impl_, def, PointOnLine{def.bodies, bodyAnchors(*impl_, def), frame});
}

int World::add(const SlideLimitDef& def) {
  checkBodies(*impl_, def);
  require(def.range[0] <= def.range[1] && std::isfinite(def.range[1] - def.range[0]),
          "a slide's limits must be ordered and finite");
  const Vec3 n = bodyAxis(*impl_, def.bodies[0], def.axis);
  return append(*impl_, def,
                SlideLimit{def.bodies, bodyAnchors(*impl_, def), n, def.range[0], def.range[1]});
}

int World::add(const OrientationLockDef& def) {
  checkBodies(*impl_, def);
  if (def.orientation) checkOrientation(*def.orientation);
  const Quat kept = def.orientation.value_or(relativeOrientation(*impl_, def.bodies));
  return append(*impl_, def, OrientationLock{def.bodies, kept.normalized()});
}

int World::add(const PerpendicularDef& def) {
  checkBodies(*impl_, def);
  const Vec3 ni = bodyAxis(*impl_, def.bodies[0], def.directions[0]);
  const Vec3 nj = bodyAxis(*impl_, def.bodies[1], def.directions[1]);
  return append(*impl_, def, Perpendicular{def.bodies, {ni, nj}});
}

int World::add(const DistanceDef& def) {
  checkBodies(*impl_, def);
  const double length = def.length.value_or(startDistance(*impl_, def.bodies, def.anchors));
  require(std::isfinite(length) && length >= 0, "a distance must not be negative");
  return append(*impl_, def, Distance{def.bodies, def.anchors, length, def.rope});
}

int World::add(const SpringDef& def) {
  checkBodies(*impl_, def);
  checkForce({def.stiffness, def.damping}, "stiffness and damping must be finite and not negative");
  const double rest = restLength(*impl_, def);
  const Form form = def.form.value_or(rest == 0 ? Form::kVector : Form::kScalar);
  require(form == Form::kScalar || rest == 0, "a spring in vector form has rest length zero");
  if (form == Form::kVector) {
    return append(*impl_, def, VectorSpring{def.bodies, def.anchors, def.stiffness, def.damping});
  }
  return append(*impl_, def, Spring{def.bodies, def.anchors, def.stiffness, def.damping, rest});
}

int World::add(const HardeningSpringDef& def) {
  checkBodies(*impl_, def);
  checkForce({def.stiffness, def.cubic, def.damping},
             "stiffness, cubic and damping must be finite and not negative");
  return append(*impl_, def,
                HardeningSpring{def.bodies, def.anchors, def.stiffness, def.cubic, def.damping,
                                restLength(*impl_, def)});
}

int World::add(const BendDef& def) {
  checkBodies(*impl_, def);
  checkForce({def.stiffness, def.damping}, "stiffness and damping must be finite and not negative");
  return append(*impl_, def, Bend{def.bodies, def.stiffness, def.damping});
}

int World::add(const PointGravityDef& def) {
  checkBodies(*impl_, def);
  checkForce({def.strength, def.softening},
             "strength and softening must be finite and not negative");
  return append(*impl_, def, PointGravity{def.bodies, def.strength, def.softening});
}

int World::add(const ForceDef& def) {
  checkBodies(*impl_, def);
  require(finite(def.force), "a force must be finite");
  return append(*impl_, def, ConstantForce{def.bodies, def.force, factorOf(def.overTime)});
}

int World::add(const DragDef& def) {
  checkBodies(*impl_, def);
  checkForce({def.coefficient}, "a drag's coefficient must be finite and not negative");
  require(finite(def.wind), "the wind must be finite");
  return append(*impl_, def, Drag{def.bodies, def.coefficient, def.wind});
}

int World::add(const PanelDragDef& def) {
  checkBodies(*impl_, def);
  checkForce({def.coefficient}, "a drag's coefficient must be finite and not negative");
  require(finite(def.wind), "the wind must be finite");
  return append(*impl_, def, PanelDrag{def.bodies, def.coefficient, def.wind});
}

int World::add(const LinkDef& def) {
  checkBodies(*impl_, def);
  checkForce({def.compliance}, "a compliance must be finite and not negative");
  const double length = def.length.value_or(startWay(*impl_, def.bodies));
  require(std::isfinite(length) && length >= 0, "a length must not be negative");
  return append(*impl_, def, Link{def.bodies, length, def.compliance, def.rope});
}

int World::add(const RopeLengthDef& def) {
  require(def.bodies.size() >= 2, "a rope needs at least two bodies");
  checkBodies(*impl_, def);
  const double length = def.length.value_or(startWay(*impl_, def.bodies));
  require(std::isfinite(length) && length >= 0, "a length must not be negative");
  return append(*impl_, def, RopeLength{def.bodies, length, def.rope});
}

int World::add(const VolumeDef& def) {
  checkBodies(*impl_, def);
  checkForce({def.compliance}, "a compliance must be finite and not negative");
  const auto& pose = impl_->bodies.pose;
  const double volume =
      def.volume.value_or(volumeOf({pose[def.bodies[0]].x, pose[def.bodies[1]].x,
                                    pose[def.bodies[2]].x, pose[def.bodies[3]].x}));
  require(
      std::isfinite(volume) && volume > 0,
      "a volume must be positive: name the corners so that 1, 2, 3 turn right-handed seen from 0");
  return append(*impl_, def, Volume{def.bodies, volume, def.compliance});
}

int World::add(const DriveDef& def) {
  checkBodies(*impl_, def);
  require(def.stiffness >= 0 && def.damping >= 0 && def.maxTorque >= 0,
          "a drive's stiffness, damping and torque must not be negative");
  if (def.target) checkOrientation(*def.target);
  require(def.target || !def.overTime, "a drive over time needs a target");
  const Quat start = relativeOrientation(*impl_, def.bodies);
  const Quat target = def.target.value_or(start).normalized();
  return append(*impl_, def,
                Drive{def.bodies, target, def.stiffness, def.damping, def.maxTorque,
                      factorOf(def.overTime), start});
}

int World::add(const MotorDef& def) {
  checkBodies(*impl_, def);
  require(std::isfinite(def.speed) && def.maxTorque >= 0,
          "a motor's speed must be finite and its torque not negative");
  const Vec3 n = impl_->bodies.pose[def.bodies[0]].q.conjugate() * direction(def.axis);
  return append(*impl_, def,
                Motor{def.bodies, n, def.speed, def.maxTorque, factorOf(def.overTime)});
}

int World::add(const MotorTorqueDef& def) {
  checkBodies(*impl_, def);
  require(std::isfinite(def.stallTorque) && def.freeSpeed > 0,
          "a motor's torque must be finite and its free speed positive");
  const Vec3 n = impl_->bodies.pose[def.bodies[0]].q.conjugate() * direction(def.axis);
  return append(*impl_, def,
                MotorTorque{def.bodies, n, def.stallTorque, def.freeSpeed, factorOf(def.overTime)});
}

}  // namespace physics
