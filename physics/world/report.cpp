// What a World tells about itself between steps.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "physics/constraints/constraint_error.h"
#include "physics/motion/second_order.h"
#include "physics/world/impl.h"

namespace physics {
namespace {

template <class K, class C>
JointReport reportOf(const C& item, const WorldState& w) {
  const Pose &a = w.bodies.pose[item.bodies[0]], &b = w.bodies.pose[item.bodies[1]];
  JointReport joint{K::kWord, item.bodies[0], item.bodies[1], a.x, b.x, Vec3::Zero(), 0};
  if constexpr (requires { item.anchors; }) {
    joint.pointA = a.x + a.q * item.anchors[0];
    joint.pointB = b.x + b.q * item.anchors[1];
  }
  if constexpr (requires { item.axisI; }) joint.axis = a.q * item.axisI;
  if constexpr (requires { item.axes; }) joint.axis = a.q * item.axes[0];
  if constexpr (requires { item.axes; }) joint.axisB = b.q * item.axes[1];
  if constexpr (requires { item.frameJ; }) joint.axisB = b.q * item.frameJ.col(2);
  if constexpr (std::is_same_v<C, ConeLimit>) joint.cone = item.angle;
  if constexpr (canStand<C>()) joint.error = sizeOfError(item, w.bodies, w.substepLength());
  return joint;
}

// A rope's pieces one by one; the error is that of the whole.
template <class K, class C>
void addPieces(const C& item, const WorldState& w, std::vector<JointReport>& reports) {
  const double error = sizeOfError(item, w.bodies, w.substepLength());
  for (std::size_t i = 0; i + 1 < item.bodies.size(); ++i) {
    JointReport piece;
    piece.kind = K::kWord;
    piece.a = item.bodies[i];
    piece.b = item.bodies[i + 1];
    piece.pointA = w.bodies.pose[piece.a].x;
    piece.pointB = w.bodies.pose[piece.b].x;
    piece.axis = piece.axisB = Vec3::Zero();
    piece.error = error;
    reports.push_back(piece);
  }
}

// Those of bodies that sleep come last.
template <class F>
void forEachPair(const WorldState& w, F&& f) {
  for (const ContactPair& pair : w.contacts.pairs) f(pair);
  for (const ContactPair& pair : w.sleep.contacts) f(pair);
  for (const auto* contacts : {&w.small.contacts(), &w.small.sleeping}) {
    for (const KeptContact& c : *contacts) {
      f(pairOf(c, w.settings.dt / w.small.substepsOf(moverOf(w.bodies, c.a, c.b))));
    }
  }
}

// Of the two shapes where they are now: since their contacts were looked for they may have gone
// past each other, and by the points of then a limb that swings past another is deep in it. Of
// triangles it is not known: infinite.
double depthOf(const WorldState& w, const ContactPair& pair) {
  const Bodies& b = w.bodies;
  for (const BodyId i : {pair.a, pair.b}) {
    const bool isMesh = std::holds_alternative<Triangles>(b.shape[i]);
    if (isMesh) return std::numeric_limits<double>::infinity();
  }
  return -w.collider.distance(pair.a, b.pose[pair.a], pair.b, b.pose[pair.b]);
}

}  // namespace

const Settings& World::settings() const { return impl_->settings; }
std::int64_t World::stepCount() const { return impl_->stepCount; }
const Bodies& World::bodies() const { return impl_->bodies; }
int World::bodyCount() const { return impl_->bodies.size(); }

void World::setThreads(int count) { impl_->workers.setCount(count); }

void World::setVelocity(BodyId body, const Velocity& velocity) {
  require(body > 0 && body < bodyCount(), "no such body");
  callAwake(impl_->sleep, body);
  Velocity& now = impl_->bodies.velocity[body];
  auto& replaced = impl_->last.replaced;
  if (velocity.v.allFinite() && velocity.w.allFinite()) {
    std::erase_if(replaced, [&](const auto& set) { return set.first == body; });
  } else {
    replaced.emplace_back(body, now);  // the step will name the body and put this back
  }
  now = velocity;
  forgetPast(impl_->bodies.second, body);
}

void World::applyForce(BodyId body, const Vec3& force, const Vec3& torque) {
  require(body > 0 && body < bodyCount(), "no such body");
  callAwake(impl_->sleep, body);
  impl_->loaded.push_back(body);
  impl_->loads[body].force += force;
  impl_->loads[body].torque += torque;
}

void World::setDriveTarget(int drive, const Quat& target) {
  auto& items = std::get<Kind<DriveDef, Drive>>(impl_->kinds).set.items;
  require(drive >= 0 && drive < static_cast<int>(items.size()), "no such drive");
  require(target.coeffs().allFinite() && target.norm() > 1e-6,
          "a drive's target must be a finite quaternion, not zero");
  const Quat next = target.normalized();
  if (next.coeffs() == items[drive].target.coeffs()) return;
  for (const BodyId body : items[drive].bodies) callAwake(impl_->sleep, body);
  items[drive].target = next;
}

Vec3 World::driveError(int drive) const {
  const auto& items = std::get<Kind<DriveDef, Drive>>(impl_->kinds).set.items;
  require(drive >= 0 && drive < static_cast<int>(items.size()), "no such drive");
  return items[drive].error(impl_->bodies.pose);
}

Vec3 World::driveTorque(int drive) const {
  const auto& set = std::get<Kind<DriveDef, Drive>>(impl_->kinds).set;
  require(drive >= 0 && drive < static_cast<int>(set.items.size()), "no such drive");
  const double h = set.lambda[drive].step;
  return h > 0 ? Vec3(set.lambda[drive].total / (h * h)) : Vec3::Zero();
}

std::vector<KindError> World::constraintErrors() const {
  std::vector<KindError> errors;
  forEachKind(impl_->kinds, [&](const auto& kind) {
    using K = std::decay_t<decltype(kind)>;
    if constexpr (canStand<typename K::Item>()) {
      if (kind.set.items.empty()) return;
      KindError error{K::kWord, K::Item::kUnit, 0, 0, static_cast<int>(kind.set.items.size()), 0};
      for (std::size_t k = 0; k < kind.set.items.size(); ++k) {
        const double size = sizeOfError(kind.set.items[k], impl_->bodies, impl_->substepLength());
        error.sum += size;
        if (!(size <= error.largest)) error.largest = size, error.worst = static_cast<int>(k);
      }
      errors.push_back(error);
    }
  });
  return errors;
}

std::vector<ContactReport> World::contacts() const {
  std::vector<ContactReport> reports;
  const auto& pose = impl_->bodies.pose;
  forEachPair(*impl_, [&](const ContactPair& pair) {
    const double h = impl_->settings.dt / substepsOf(moverOf(impl_->bodies, pair.a, pair.b));
    const Vec3 n = normalOf(pair, pose);
    for (int k = 0; k < pair.count; ++k) {
      const ContactPointState& p = pair.points[k];
      const double gap = gapOf(pair, k, pose);
      if (gap > impl_->settings.contact->margin && p.normalTotal == 0) continue;
      const Vec3 impulse = (p.normalTotal * n + p.frictionTotal) / h;
      reports.push_back({pair.a, pair.b, pointOf(pair, k, pose), n, gap, impulse});
    }
  });
  for (const SoftContact& c : impl_->softContacts) {
    const Vec3 n = pose[c.body].q * c.normal;
    const int substeps = substepsOf(moverOf(impl_->bodies, c.from, c.to));
    const double h = impl_->settings.dt / substeps;
    reports.push_back({c.from, c.body, pointOf(c, pose) - c.radius * n, n, gapOf(c, pose),
                       (c.normalTotal * n + c.frictionTotal) / h});
  }
  return reports;
}

std::vector<JointReport> World::joints() const {
  std::vector<JointReport> reports;
  forEachKind(impl_->kinds, [&](const auto& kind) {
    using K = std::decay_t<decltype(kind)>;
    if constexpr (K::Item::kBodies == 2) {
      for (const auto& item : kind.set.items) reports.push_back(reportOf<K>(item, *impl_));
    } else if constexpr (K::Item::kBodies == kMany) {
      for (const auto& item : kind.set.items) addPieces<K>(item, *impl_, reports);
    }
  });
  return reports;
}

std::vector<VolumeReport> World::volumes() const {
  std::vector<VolumeReport> reports;
  for (const Volume& item : std::get<Kind<VolumeDef, Volume>>(impl_->kinds).set.items) {
    Row<4, 1> row;
    item.evaluate({impl_->bodies.pose, impl_->bodies.start, impl_->substepLength()}, row);
    VolumeReport report{item.bodies, {}, item.relativeError(impl_->bodies.pose)};
    for (int k = 0; k < 4; ++k) report.gradient[k] = row.linear[k].transpose();
    reports.push_back(report);
  }
  return reports;
}

double World::largestOverlap() const {
  double largest = 0;
  forEachPair(*impl_, [&](const ContactPair& pair) {
    double deepest = 0;
    for (int k = 0; k < pair.count; ++k) {
      deepest = std::max(deepest, -gapOf(pair, k, impl_->bodies.pose));
    }
    if (deepest > largest) largest = std::max(largest, std::min(deepest, depthOf(*impl_, pair)));
  });
  for (const SoftContact& contact : impl_->softContacts) {
    largest = std::max(largest, -gapOf(contact, impl_->bodies.pose));
  }
  return largest;
}

int World::contactCount() const {
  int count = 0;
  forEachPair(*impl_, [&](const ContactPair& pair) {
    for (int k = 0; k < pair.count; ++k) count += pair.points[k].normalTotal > 0;
  });
  for (const SoftContact& contact : impl_->softContacts) count += contact.normalTotal > 0;
  return count;
}

double World::springEnergy() const {
  double energy = 0;
  forEachKind(impl_->kinds, [&](const auto& kind) {
    for (const auto& item : kind.set.items) {
      if constexpr (requires { item.energy(impl_->bodies.pose); }) {
        energy += item.energy(impl_->bodies.pose);
      }
    }
  });
  return energy;
}

}  // namespace physics
