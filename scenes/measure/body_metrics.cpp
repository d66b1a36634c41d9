// The table of metrics of one body, or of several.
#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "scenes/measure/metrics.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Pose;
using physics::Vec3;
using About = Metric::About;

const physics::Velocity& velocityOf(const Sample& s, BodyId b) {
  return s.simulation.world().bodies().velocity[b];
}

double heightOf(const Sample& s, BodyId b) { return poseOf(s, b).x.y(); }
double xOf(const Sample& s, BodyId b) { return poseOf(s, b).x.x(); }
double zOf(const Sample& s, BodyId b) { return poseOf(s, b).x.z(); }
double xVelocityOf(const Sample& s, BodyId b) { return velocityOf(s, b).v.x(); }
double yVelocityOf(const Sample& s, BodyId b) { return velocityOf(s, b).v.y(); }
double zVelocityOf(const Sample& s, BodyId b) { return velocityOf(s, b).v.z(); }
double speedOf(const Sample& s, BodyId b) { return velocityOf(s, b).v.norm(); }
double angularSpeedOf(const Sample& s, BodyId b) { return velocityOf(s, b).w.norm(); }

// What turns about the body's own axis of symmetry: y, along which capsules and cylinders lie.
double spinOf(const Sample& s, BodyId b) {
  return velocityOf(s, b).w.dot(poseOf(s, b).q * Vec3::UnitY());
}

// The turn since the start, by the shorter way.
double turnOf(const Sample& s, BodyId b) {
  const physics::Quat turn = poseOf(s, b).q * s.startPoses[b].q.conjugate();
  return physics::logarithm(turn).norm();
}

// The turn since the start about the vertical through the origin of where the body's centre is; the
// vertical is that of gravity. 0 where the centre is on it.
double azimuthOf(const Sample& s, BodyId b) {
  const auto& gravity = s.simulation.world().settings().gravity;
  const Vec3 up = gravity && !gravity->isZero(0) ? Vec3(-gravity->normalized()) : Vec3::UnitY();
  const Vec3 from = s.startPoses[b].x, to = poseOf(s, b).x;
  const Vec3 a = from - up * up.dot(from), c = to - up * up.dot(to);
  return std::atan2(up.dot(a.cross(c)), a.dot(c));
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

// Bodies that have fallen although one before them in the row has not.
double outOfTurn(const Sample& s) {
  const auto stands = [&](BodyId b) { return tiltOf(s, b) <= 45; };
  const auto first = std::find_if(s.bodies.begin(), s.bodies.end(), stands);
  return static_cast<double>(s.bodies.end() - first - std::count_if(first, s.bodies.end(), stands));
}

constexpr About kEach = About::kEachBody, kGroup = About::kGroup;
constexpr Metric kBodyMetrics[] = {
    {"height", "m", "y of a body's centre of mass", kEach, nullptr, heightOf},
    {"x", "m", "x of a body's centre of mass", kEach, nullptr, xOf},
    {"y", "m", "y of a body's centre of mass", kEach, nullptr, heightOf},
    {"z", "m", "z of a body's centre of mass", kEach, nullptr, zOf},
    {"vx", "m/s", "x of the velocity of a body's centre of mass", kEach, nullptr, xVelocityOf},
    {"vy", "m/s", "y of the velocity of a body's centre of mass", kEach, nullptr, yVelocityOf},
    {"vz", "m/s", "z of the velocity of a body's centre of mass", kEach, nullptr, zVelocityOf},
    {"speed", "m/s", "the speed of a body's centre of mass", kEach, nullptr, speedOf},
    {"angular_speed", "rad/s", "the angular speed of a body", kEach, nullptr, angularSpeedOf},
    {"spin", "rad/s", "the angular velocity of a body about its own y axis", kEach, nullptr,
     spinOf},
    {"turn", "rad", "the angle between a body's orientation and that of its start", kEach, nullptr,
     turnOf},
    {"azimuth", "rad",
     "the angle that a body's centre has gone about the vertical through the origin", kEach,
     nullptr, azimuthOf},
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
    {"out_of_turn", "",
     "how many of the bodies have tilted by more than 45 degrees before one that comes earlier",
     kGroup, outOfTurn, nullptr},
};

}  // namespace

std::span<const Metric> bodyMetrics() { return kBodyMetrics; }

bool matches(const Patterns& patterns, const std::string& name) {
  return std::any_of(patterns.any.begin(), patterns.any.end(),
                     [&](const std::string& pattern) { return matches(pattern, name); });
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
