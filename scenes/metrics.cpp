// The table of metrics: name, unit, meaning and computation of all that an [[expect]] can ask for.
// `at_most` looks at the largest value over the span and the bodies, `at_least` at the smallest.
#include "scenes/metrics.h"

#include <algorithm>
#include <cmath>

#include "physics/rotation.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Pose;
using physics::Vec3;
using About = Metric::About;

const Pose& poseOf(const Sample& s, BodyId b) { return s.simulation.world().bodies().pose[b]; }
Vec3 moved(const Sample& s, BodyId b) { return poseOf(s, b).x - s.startPoses[b].x; }

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
  return largestError(s, {"ball_socket", "distance", "link", "rope_length"});
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
double finite(const Sample& s) { return s.simulation.isFinite() ? 1 : 0; }

double heightOf(const Sample& s, BodyId b) { return poseOf(s, b).x.y(); }
double xOf(const Sample& s, BodyId b) { return poseOf(s, b).x.x(); }
double zOf(const Sample& s, BodyId b) { return poseOf(s, b).x.z(); }
double speedOf(const Sample& s, BodyId b) {
  return s.simulation.world().bodies().velocity[b].v.norm();
}
double angularSpeedOf(const Sample& s, BodyId b) {
  return s.simulation.world().bodies().velocity[b].w.norm();
}
double driftOf(const Sample& s, BodyId b) { return std::hypot(moved(s, b).x(), moved(s, b).z()); }
double dropOf(const Sample& s, BodyId b) { return -moved(s, b).y(); }
double displacementOf(const Sample& s, BodyId b) { return moved(s, b).norm(); }

// The angle between the vertical and where the body's turn has taken what was vertical at the
// start.
double tiltOf(const Sample& s, BodyId b) {
  const Vec3 up = poseOf(s, b).q * (s.startPoses[b].q.conjugate() * Vec3::UnitY());
  return std::atan2(std::hypot(up.x(), up.z()), up.y()) * 180 / M_PI;
}

// The length of a vector, with the sign of its largest component.
double signedLength(const Vec3& v) {
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  return v[largest] < 0 ? -v.norm() : v.norm();
}

// What World tells of the drive that turns this body; 0 where none does.
double ofDrive(const Sample& s, BodyId b, Vec3 (physics::World::*report)(int) const) {
  int drive = 0;
  for (const physics::JointReport& joint : s.simulation.world().joints()) {
    if (joint.kind != physics::DriveDef::kWord) continue;
    if (joint.b == b) return signedLength((s.simulation.world().*report)(drive));
    ++drive;
  }
  return 0;
}
double driveAngle(const Sample& s, BodyId b) { return -ofDrive(s, b, &physics::World::driveError); }
double driveError(const Sample& s, BodyId b) { return std::abs(driveAngle(s, b)); }
double driveTorque(const Sample& s, BodyId b) {
  return ofDrive(s, b, &physics::World::driveTorque);
}

double countTilted(const Sample& s) {
  return static_cast<double>(
      std::count_if(s.bodies.begin(), s.bodies.end(), [&](BodyId b) { return tiltOf(s, b) > 45; }));
}

double fallen(const Sample& s) {
  return s.bodies.empty() ? 0 : countTilted(s) / static_cast<double>(s.bodies.size());
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

constexpr About kScene = About::kScene, kEach = About::kEachBody, kGroup = About::kGroup;
constexpr Metric kMetrics[] = {
    {"joint_error", "m", "the largest gap of a ball_socket or error of a distance, link or rope",
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
    {"cone_limit_error", "rad", "the largest angle beyond a cone_limit", kScene,
     kindError<physics::ConeLimitDef>, nullptr},
    {"twist_limit_error", "rad", "the largest angle beyond a twist_limit", kScene,
     kindError<physics::TwistLimitDef>, nullptr},
    {"energy_drift", "", "(E - E0) / max(|E0|, largest kinetic energy so far)", kScene, energyDrift,
     nullptr},
    {"energy_gain", "J", "E - E0", kScene, energyGain, nullptr},
    {"momentum_drift", "", "|P - P0| / max(|P0|, sqrt(2 M K), K the largest kinetic energy so far)",
     kScene, momentumDrift, nullptr},
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
    {"max_speed", "m/s", "the speed of the fastest body", kScene, maxSpeed, nullptr},
    {"arm_error", "m", "the largest distance of an arm's tip from its target", kScene, armError,
     nullptr},
    {"arm_tip_share", "",
     "of all that an arm's joints have turned since the start, the part of the last two", kScene,
     armTipShare, nullptr},
    {"arm_effort", "kg m^2 rad^2", "the sum of 1/2 dtheta^T M dtheta over all iterations so far",
     kScene, armEffort, nullptr},
    {"contacts", "", "the contact points that carry an impulse", kScene, contacts, nullptr},
    {"finite", "", "1 while every number is finite, else 0", kScene, finite, nullptr},
    {"height", "m", "y of a body's centre of mass", kEach, nullptr, heightOf},
    {"x", "m", "x of a body's centre of mass", kEach, nullptr, xOf},
    {"y", "m", "y of a body's centre of mass", kEach, nullptr, heightOf},
    {"z", "m", "z of a body's centre of mass", kEach, nullptr, zOf},
    {"speed", "m/s", "the speed of a body's centre of mass", kEach, nullptr, speedOf},
    {"angular_speed", "rad/s", "the angular speed of a body", kEach, nullptr, angularSpeedOf},
    {"drift", "m", "a body's horizontal distance from its start", kEach, nullptr, driftOf},
    {"drop", "m", "how far a body is below its start", kEach, nullptr, dropOf},
    {"displacement", "m", "a body's distance from its start", kEach, nullptr, displacementOf},
    {"tilt", "degrees", "the angle a body's vertical has turned from the vertical since its start",
     kEach, nullptr, tiltOf},
    {"drive_angle", "rad", "the turn from a driven body to its target, signed as its largest part",
     kEach, nullptr, driveAngle},
    {"drive_error", "rad", "the angle from a driven body to its target", kEach, nullptr,
     driveError},
    {"drive_torque", "N m", "the torque of its drive on a body, signed as its largest part", kEach,
     nullptr, driveTorque},
    {"count_tilted", "", "how many of the bodies have tilted by more than 45 degrees", kGroup,
     countTilted, nullptr},
    {"fallen", "", "the fraction of the bodies that have tilted by more than 45 degrees", kGroup,
     fallen, nullptr},
};

}  // namespace

std::span<const Metric> metrics() { return kMetrics; }

std::vector<std::string> metricNames() {
  std::vector<std::string> names;
  for (const Metric& metric : kMetrics) names.emplace_back(metric.name);
  return names;
}

const Metric* findMetric(const std::string& name) {
  for (const Metric& metric : kMetrics) {
    if (name == metric.name) return &metric;
  }
  return nullptr;
}

bool matches(const std::string& pattern, const std::string& name) {
  size_t p = 0, n = 0, star = std::string::npos, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (star != std::string::npos) {
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

}  // namespace scenes
