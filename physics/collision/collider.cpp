// Manifolds of the watched pairs: kept while a pair hardly moves, swept where it moves fast.
#include "physics/collision/collider.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/collision/narrow.h"
#include "physics/collision/pairs.h"
#include "physics/collision/sweep.h"

namespace physics {

using namespace collision;

namespace {

constexpr double kStill = 1e-4;  // of the size, and rad: a pair that moved less keeps its manifold
constexpr double kSpare = 0.1;   // of the margin: looked further than asked, so that manifolds last

double smallerSize(const Solid& a, const Solid& b) {
  if (a.size == 0 || b.size == 0) return a.size + b.size;
  return std::min(a.size, b.size);
}

// The most that two items can come closer during the step.
double approach(const Item& a, const Item& b) {
  if (b.solid.kind != Kind::plane) return (a.move - b.move).norm() + a.turn + b.turn;
  return std::max(0.0, -(b.R * b.solid.normal).dot(a.move - b.move)) + a.turn;
}

}  // namespace

struct Collider::Impl {
  Pairs pairs;
  std::vector<Manifold> manifolds;
  std::int64_t narrowPhaseCalls = 0;

  // The part of the step that a pair is looked at, and with what.
  struct Step {
    std::span<const Pose> start, end;
    double margin = 0;
  };

  // Whether what was found before still holds at `pose` for surfaces up to `reach` apart.
  static bool holds(const Watch& watch, const Item& a, const Item& b, const Relative& pose,
                    double reach) {
    if (!watch.known) return false;
    const double shift = (pose.t - watch.pose.t).norm();
    const double turn = (pose.R - watch.pose.R).norm() * std::sqrt(0.5);
    if (watch.manifold.count == 0 && watch.distance - shift - turn * a.solid.coreRadius > reach) {
      return true;
    }
    return shift <= kStill * smallerSize(a.solid, b.solid) && turn <= kStill &&
           reach <= watch.reach;
  }

  void look(Watch& watch, const Step& step) {
    const Item &a = pairs.items()[watch.a], &b = pairs.items()[watch.b];
    const Mat3 toB = b.R.transpose();
    const Relative pose{toB * a.R, toB * (a.x - b.x)};
    const double closing = approach(a, b), reach = step.margin + closing;
    if (holds(watch, a, b, pose, reach)) return;
    const bool plane = b.solid.kind == Kind::plane;
    watch.known = true;
    watch.pose = pose;
    watch.reach = reach + kSpare * step.margin;
    const double near = plane ? reach : step.margin;
    watch.distance = touch(a.solid, b.solid, pose, near, watch.reach, watch.manifold);
    ++narrowPhaseCalls;
    if (plane || watch.distance <= near || watch.distance > reach) return;
    lookAlong(watch, a, b, step);
    watch.known = watch.manifold.count == 0;
  }

  // Not near at the start but fast enough to be within the step: the manifold of the first touch,
  // or, when there is none, that of the end.
  void lookAlong(Watch& watch, const Item& a, const Item& b, const Step& step) {
    const Way wayA{step.start[a.body], step.end[a.body]};
    const Way wayB{step.start[b.body], step.end[b.body]};
    const double close = std::max(0.1 * step.margin, 1e-4 * smallerSize(a.solid, b.solid));
    const double part =
        firstTouch(a.solid, wayA, b.solid, wayB, close, narrowPhaseCalls).value_or(1.0);
    const Relative pose = relativePose(along(wayA, part), along(wayB, part));
    const double near = std::max(close, step.margin);
    const double keep = near + (1 - part) * approach(a, b);
    touch(a.solid, b.solid, pose, near, keep, watch.manifold);
    ++narrowPhaseCalls;
  }
};

Collider::Collider() : impl_(std::make_unique<Impl>()) {}
Collider::~Collider() = default;
Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;

void Collider::add(BodyId body, const Shape& shape, bool movable) {
  impl_->pairs.add(body, shape, movable);
}

void Collider::ignore(BodyId a, BodyId b) { impl_->pairs.ignore(a, b); }

std::span<const Manifold> Collider::find(std::span<const Pose> start, std::span<const Pose> end,
                                         double margin) {
  require(margin >= 0, "collider: margin must not be negative");
  impl_->pairs.update(start, end, margin);
  impl_->manifolds.clear();
  for (const Pairs::Key& key : impl_->pairs.keys()) {
    Watch& watch = impl_->pairs.watch(key);
    impl_->look(watch, {start, end, margin});
    if (watch.manifold.count > 0) impl_->manifolds.push_back(watch.manifold);
  }
  return impl_->manifolds;
}

bool Collider::outdated(std::span<const Pose> start, std::span<const Pose> end) const {
  return impl_->pairs.outdated(start, end);
}

double Collider::distance(BodyId a, const Pose& poseA, BodyId b, const Pose& poseB) const {
  const int first = impl_->pairs.indexOf(a), second = impl_->pairs.indexOf(b);
  if (first < 0 || second < 0) return std::numeric_limits<double>::infinity();
  const Solid& solidA = impl_->pairs.items()[first].solid;
  const Solid& solidB = impl_->pairs.items()[second].solid;
  return signedDistance(solidA, solidB, relativePose(poseA, poseB));
}

Collider::Counts Collider::counts() const {
  return {impl_->narrowPhaseCalls, impl_->pairs.broadPhaseCalls(),
          static_cast<int>(impl_->pairs.keys().size())};
}

}  // namespace physics
