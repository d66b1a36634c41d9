// Distances between two runs, body by body.
#include "app/trust/difference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "physics/base/rotation.h"

namespace app {

namespace {

using physics::BodyId;
using physics::Vec3;

// Bodies that move, by what joins them: each group by its first body.
class Groups {
 public:
  explicit Groups(const physics::World& world) : of_(world.bodies().pose.size()) {
    std::iota(of_.begin(), of_.end(), 0);
    for (const physics::JointReport& joint : world.joints()) join(world, joint.a, joint.b);
    for (const physics::VolumeReport& volume : world.volumes()) {
      for (const BodyId b : volume.bodies) join(world, volume.bodies[0], b);
    }
  }
  int of(BodyId b) const {
    int root = b;
    while (of_[root] != root) root = of_[root];
    return root;
  }

 private:
  void join(const physics::World& world, BodyId a, BodyId b) {
    const auto& motion = world.bodies().motion;
    if (motion[a] != physics::Motion::kDynamic || motion[b] != physics::Motion::kDynamic) return;
    const int rootA = of(a), rootB = of(b);
    of_[std::max(rootA, rootB)] = std::min(rootA, rootB);
  }
  std::vector<int> of_;
};

struct Extent {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  double least = 0;  // m

  void include(const Vec3& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  double size() const { return low.x() > high.x() ? least : std::max(least, (high - low).norm()); }
};

// x y z qw qx qy qz vx vy vz wx wy wz, as a trajectory has them.
constexpr std::array<const char*, 13> kQuantities = {"x",  "y",  "z",  "qw", "qx", "qy", "qz",
                                                     "vx", "vy", "vz", "wx", "wy", "wz"};
std::array<double, 13> numbersOf(const TrackFrame& frame, std::size_t body) {
  const physics::Pose& p = frame.poses[body];
  const physics::Velocity& u = frame.velocities[body];
  return {p.x.x(), p.x.y(), p.x.z(), p.q.w(), p.q.x(), p.q.y(), p.q.z(),
          u.v.x(), u.v.y(), u.v.z(), u.w.x(), u.w.y(), u.w.z()};
}

// Takes over the largest difference of a body.
void compare(const TrackFrame& a, const TrackFrame& b, std::size_t body, std::size_t numbers,
             Parting& parting) {
  const std::array<double, 13> was = numbersOf(a, body), is = numbersOf(b, body);
  bool differs = false;
  for (std::size_t k = 0; k < numbers; ++k) {
    if (std::bit_cast<std::uint64_t>(was[k]) == std::bit_cast<std::uint64_t>(is[k])) continue;
    differs = true;
    const bool isLarger = std::abs(was[k] - is[k]) > std::abs(parting.a - parting.b);
    if (parting.body > 0 && !isLarger) continue;
    parting.body = static_cast<BodyId>(body);
    parting.quantity = kQuantities[k];
    parting.a = was[k];
    parting.b = is[k];
    parting.distance = (a.poses[body].x - b.poses[body].x).norm();
  }
  parting.bodies += differs;
}

}  // namespace

std::vector<Allowed> allowedOf(const scenes::Simulation& start, double accuracy) {
  const physics::World& world = start.world();
  const physics::Bodies& bodies = world.bodies();
  const Groups groups(world);
  std::vector<Allowed> all(bodies.pose.size());
  std::vector<Extent> extents(all.size());
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] != physics::Motion::kDynamic) continue;
    all[b].moves = true;
    all[b].group = groups.of(b);
    const double radius = physics::boundingRadius(bodies.shape[b]);
    all[b].radius = bodies.inverseInertia[b].isZero(0) ? 0 : radius;
    Extent& extent = extents[all[b].group];
    extent.include(bodies.pose[b].x);
    extent.least = std::max(extent.least, 2 * radius);
  }
  for (const physics::JointReport& joint : world.joints()) {
    const BodyId b = all[joint.a].moves ? joint.a : joint.b;
    if (!all[b].moves) continue;
    extents[all[b].group].include(joint.pointA);
    extents[all[b].group].include(joint.pointB);
  }
  for (Allowed& one : all) {
    if (!one.moves) continue;
    one.size = extents[one.group].size();
    one.distance = accuracy * one.size;
  }
  return all;
}

double apart(const physics::Pose& a, const physics::Pose& b, double radius) {
  const double turned = radius > 0 ? physics::logarithm(a.q * b.q.conjugate()).norm() : 0;
  return (a.x - b.x).norm() + 2 * radius * std::sin(turned / 2);
}

double apart(const physics::Velocity& a, const physics::Velocity& b, double radius) {
  return (a.v - b.v).norm() + radius * (a.w - b.w).norm();
}

std::vector<FrameDifference> differencesOf(const Track& a, const Track& b,
                                           const std::vector<Allowed>& allowed) {
  std::vector<FrameDifference> all;
  for (int f = 0; f < std::min(a.frameCount(), b.frameCount()); ++f) {
    FrameDifference worst;
    worst.time = a.frames[f].time;
    for (std::size_t body = 1; body < allowed.size(); ++body) {
      const Allowed& of = allowed[body];
      if (!of.moves) continue;
      const double distance = apart(a.frames[f].poses[body], b.frames[f].poses[body], of.radius);
      worst.beyond += distance > of.distance;
      if (worst.body > 0 && distance * worst.allowed <= worst.distance * of.distance) continue;
      worst.body = static_cast<BodyId>(body);
      worst.distance = distance;
      worst.allowed = of.distance;
    }
    all.push_back(worst);
  }
  return all;
}

int firstDifference(std::span<const std::string> a, std::span<const std::string> b) {
  const auto [at, other] = std::mismatch(
      a.begin(), a.begin() + static_cast<long>(std::min(a.size(), b.size())), b.begin());
  return at - a.begin() < static_cast<long>(std::min(a.size(), b.size()))
             ? static_cast<int>(at - a.begin())
             : -1;
}

Parting firstParting(const Track& a, const Track& b) {
  constexpr std::size_t kPoseNumbers = 7;
  const bool both = a.hasVelocities && b.hasVelocities;
  const std::size_t numbers = both ? kQuantities.size() : kPoseNumbers;
  for (int f = 0; f < std::min(a.frameCount(), b.frameCount()); ++f) {
    Parting parting;
    for (std::size_t body = 1; body < a.frames[f].poses.size(); ++body) {
      compare(a.frames[f], b.frames[f], body, numbers, parting);
    }
    parting.frame = f;
    if (parting.bodies > 0) return parting;
  }
  return {};
}

}  // namespace app
