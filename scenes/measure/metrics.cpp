// The table of metrics of a whole scene: name, unit, meaning and computation of what an [[expect]]
// can ask for; those of single bodies are in body_metrics.cpp.
// `at_most` looks at the largest value over the span and the bodies, `at_least` at the smallest.
#include "scenes/measure/metrics.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Pose;
using physics::Vec3;
using About = Metric::About;

double largestError(const Sample& s, std::initializer_list<const char*> kinds) {
  double largest = 0;
  for (const physics::KindError& error : s.now.errors) {
    for (const char* kind : kinds) {
      if (error.kind == kind) largest = std::max(largest, error.largest);
    }
  }
  return largest;
}

template <class Def>
double kindError(const Sample& s) {
  return largestError(s, {Def::kWord});
}

double jointError(const Sample& s) {
  return largestError(s, {"ball_socket", "point_on_line", "distance", "link", "rope_length"});
}

// The sum of |c| over the links: how far off a rope or a cloth is as a whole.
double linkErrorSum(const Sample& s) {
  for (const physics::KindError& error : s.now.errors) {
    if (error.kind == physics::LinkDef::kWord) return error.sum;
  }
  return 0;
}

double gradientError(const Sample& s) { return s.simulation.world().gradientError(); }

// Energy that a loss or a gain is measured against.
double energyScale(const Sample& s) { return std::max(std::abs(s.start.total), s.largestKinetic); }

double energyGain(const Sample& s) { return s.now.total - s.start.total; }

double energyDrift(const Sample& s) {
  const double scale = energyScale(s);
  return scale > 0 ? energyGain(s) / scale : energyGain(s);
}

double energyRise(const Sample& s) {
  const double rise = s.now.total - s.before.total, scale = energyScale(s);
  return scale > 0 ? rise / scale : rise;
}

double movingMass(const Sample& s) {
  const physics::Bodies& bodies = s.simulation.world().bodies();
  double mass = 0;
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] == physics::Motion::kDynamic) mass += bodies.mass[b];
  }
  return mass;
}

// sqrt(2 M K) is the largest momentum that this kinetic energy allows.
double momentumDrift(const Sample& s) {
  const double drift = (s.now.linearMomentum - s.start.linearMomentum).norm();
  const double scale =
      std::max(s.start.linearMomentum.norm(), std::sqrt(2 * movingMass(s) * s.largestKinetic));
  return scale > 0 ? drift / scale : drift;
}

double angularMomentumDrift(const Sample& s) {
  const double drift = (s.now.angularMomentum - s.start.angularMomentum).norm();
  const double scale = s.start.angularMomentum.norm();
  return scale > 1e-12 ? drift / scale : drift;
}

// How far the common centre of mass has moved, in metres: forces within the scene cannot do that.
double centreDrift(const Sample& s) {
  const physics::Bodies& bodies = s.simulation.world().bodies();
  Vec3 sum = Vec3::Zero();
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] == physics::Motion::kDynamic) sum += bodies.mass[b] * moved(s, b);
  }
  const double mass = movingMass(s);
  return mass > 0 ? (sum / mass).norm() : 0;
}

// The moment about the origin of what moved and turned since the start, sum of m x0 x dx + I0
// dtheta. After one impulse it is the impulse's own: zero unless that turns something (5.1).
double momentDrift(const Sample& s) {
  const physics::Bodies& bodies = s.simulation.world().bodies();
  Vec3 sum = Vec3::Zero();
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] != physics::Motion::kDynamic) continue;
    const Pose& start = s.startPoses[b];
    const Vec3 turn = physics::logarithm(poseOf(s, b).q * start.q.conjugate());
    const Vec3 inBody = bodies.inertia[b].cwiseProduct(start.q.conjugate() * turn);
    sum += bodies.mass[b] * start.x.cross(moved(s, b)) + start.q * inBody;
  }
  return sum.norm();
}

// How far the sum of all momenta has moved [kg m/s].
double momentumGain(const Sample& s) {
  return (s.now.linearMomentum - s.start.linearMomentum).norm();
}

// The sum of the squared overlaps of all contact points [m^2].
double overlapSquares(const Sample& s) {
  double sum = 0;
  for (const physics::ContactReport& contact : s.simulation.world().contacts()) {
    if (contact.gap < 0) sum += contact.gap * contact.gap;
  }
  return sum;
}

// The largest angle between the two axes of a constraint of that kind.
double largestAngle(const Sample& s, const char* kind) {
  double largest = 0;
  for (const physics::JointReport& joint : s.simulation.world().joints()) {
    if (joint.kind != kind) continue;
    const double sine = joint.axis.cross(joint.axisB).norm();
    largest = std::max(largest, std::atan2(sine, joint.axis.dot(joint.axisB)));
  }
  return largest * 180 / M_PI;
}
double axleAngle(const Sample& s) { return largestAngle(s, physics::AxleDef::kWord); }
double coneAngle(const Sample& s) { return largestAngle(s, physics::ConeLimitDef::kWord); }

double overlap(const Sample& s) { return s.now.overlap; }
double maxSpeed(const Sample& s) { return s.now.maxSpeed; }
double contacts(const Sample& s) { return s.now.contacts; }
double finite(const Sample& s) {
  return s.simulation.isFinite() && std::isfinite(s.now.total) ? 1 : 0;
}

double armError(const Sample& s) { return largestError(s, {physics::ArmDef::kWord}); }

double armTipShare(const Sample& s) {
  double least = 1;
  for (const physics::ArmReport& arm : s.simulation.world().arms()) {
    double all = 0, last = 0;
    for (size_t k = 0; k < arm.turned.size(); ++k) {
      all += arm.turned[k];
      if (k + 2 >= arm.turned.size()) last += arm.turned[k];
    }
    least = std::min(least, all > 0 ? last / all : 0);
  }
  return least;
}

double armEffort(const Sample& s) {
  double sum = 0;
  for (const physics::ArmReport& arm : s.simulation.world().arms()) sum += arm.effort;
  return sum;
}

constexpr About kScene = About::kScene;
constexpr Metric kMetrics[] = {
    {"joint_error", "m",
     "the largest gap of a ball_socket or point_on_line, or error of a distance, link or rope",
     kScene, jointError, nullptr},
    {"ball_socket_error", "m", "the largest gap of a ball_socket", kScene,
     kindError<physics::BallSocketDef>, nullptr},
    {"distance_error", "m", "the largest error of a distance", kScene,
     kindError<physics::DistanceDef>, nullptr},
    {"link_error", "m", "the largest error of a link", kScene, kindError<physics::LinkDef>,
     nullptr},
    {"link_error_sum", "m", "the sum of the errors of all links", kScene, linkErrorSum, nullptr},
    {"rope_length_error", "m", "the largest error of a rope_length", kScene,
     kindError<physics::RopeLengthDef>, nullptr},
    {"volume_error", "", "the largest |V/V0 - 1| of a volume", kScene,
     kindError<physics::VolumeDef>, nullptr},
    {"gradient_error", "", "the largest difference of a gradient from differences, relative",
     kScene, gradientError, nullptr},
    {"axle_error", "rad", "the largest angle an axle is open", kScene, kindError<physics::AxleDef>,
     nullptr},
    {"point_on_line_error", "m", "the largest distance of a point from its line", kScene,
     kindError<physics::PointOnLineDef>, nullptr},
    {"slide_limit_error", "m", "the largest distance beyond a slide_limit", kScene,
     kindError<physics::SlideLimitDef>, nullptr},
    {"orientation_lock_error", "rad", "the largest turn past an orientation_lock", kScene,
     kindError<physics::OrientationLockDef>, nullptr},
    {"perpendicular_error", "rad", "the largest angle off the right angle of a perpendicular",
     kScene, kindError<physics::PerpendicularDef>, nullptr},
    {"cone_limit_error", "rad", "the largest angle beyond a cone_limit", kScene,
     kindError<physics::ConeLimitDef>, nullptr},
    {"twist_limit_error", "rad", "the largest angle beyond a twist_limit", kScene,
     kindError<physics::TwistLimitDef>, nullptr},
    {"energy_drift", "", "(E - E0) / max(|E0|, largest kinetic energy so far)", kScene, energyDrift,
     nullptr, true},
    {"energy_gain", "J", "E - E0", kScene, energyGain, nullptr, true},
    {"energy_rise", "", "(E - E of the frame before) / max(|E0|, largest kinetic energy so far)",
     kScene, energyRise, nullptr, true},
    {"momentum_drift", "", "|P - P0| / max(|P0|, sqrt(2 M K), K the largest kinetic energy so far)",
     kScene, momentumDrift, nullptr},
    {"momentum_gain", "kg m/s", "|P - P0|", kScene, momentumGain, nullptr},
    {"angular_momentum_drift", "", "|L - L0| / |L0|, in kg m^2/s where L0 is zero", kScene,
     angularMomentumDrift, nullptr},
    {"axle_angle", "degrees", "the largest angle between the two axes of an axle", kScene,
     axleAngle, nullptr},
    {"cone_angle", "degrees", "the largest angle between the two axes of a cone_limit", kScene,
     coneAngle, nullptr},
    {"centre_drift", "m", "how far the common centre of mass has moved", kScene, centreDrift,
     nullptr},
    {"moment_drift", "kg m^2",
     "the moment about the origin of what moved and turned since the start", kScene, momentDrift,
     nullptr},
    {"overlap", "m", "the deepest overlap of two bodies", kScene, overlap, nullptr},
    {"overlap_squares", "m^2", "the sum of the squared overlaps of all contact points", kScene,
     overlapSquares, nullptr},
    {"max_speed", "m/s", "the speed of the fastest body", kScene, maxSpeed, nullptr},
    {"arm_error", "m", "the largest distance of an arm's tip from its target", kScene, armError,
     nullptr},
    {"arm_tip_share", "",
     "of all that an arm's joints have turned since the start, the part of the last two", kScene,
     armTipShare, nullptr},
    {"arm_effort", "kg m^2 rad^2", "the sum of 1/2 dtheta^T M dtheta over all iterations so far",
     kScene, armEffort, nullptr},
    {"contacts", "", "the contact points that carry an impulse", kScene, contacts, nullptr},
    {"finite", "", "1 while every number and the energy are finite, else 0", kScene, finite,
     nullptr},
};

}  // namespace

std::span<const Metric> metrics() {
  static const std::vector<Metric> all = [] {
    std::vector<Metric> both(std::begin(kMetrics), std::end(kMetrics));
    both.insert(both.end(), bodyMetrics().begin(), bodyMetrics().end());
    return both;
  }();
  return all;
}

std::vector<std::string> metricNames() {
  std::vector<std::string> names;
  for (const Metric& metric : metrics()) names.emplace_back(metric.name);
  return names;
}

const Metric* findMetric(const std::string& name) {
  for (const Metric& metric : metrics()) {
    if (name == metric.name) return &metric;
  }
  return nullptr;
}

}  // namespace scenes
