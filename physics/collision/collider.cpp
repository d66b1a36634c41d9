// Manifolds of the watched pairs: kept while a pair hardly moves, swept where it moves fast.
#include "physics/collision/collider.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "physics/base/archive.h"
#include "physics/base/profile.h"
#include "physics/base/workers.h"
#include "physics/collision/contacts.h"
#include "physics/collision/mesh_contacts.h"
#include "physics/collision/narrow.h"
#include "physics/collision/pairs.h"
#include "physics/collision/sweep.h"

namespace physics {

using namespace collision;

namespace {

// A pair that moved less keeps its manifold, of the size and in rad: at rest, and in motion. Points
// are carried by both bodies, so that their gaps are off by the square of it.
constexpr double kStill = 1e-4, kStillInMotion = 3e-3;
constexpr double kStillOfMargin = 0.25;  // then no point that is near was missed
constexpr double kLooksInMotion = 2;     // it is kept for, so that what comes to rest is looked at
constexpr double kShort = 0.1;           // of the thickness
constexpr double kSpare = 0.1;  // of the margin: looked further than asked, so that manifolds last

// The most that two items can come closer during the step along n, from b to a.
double approach(const Item& a, const Item& b, const Vec3& n) {
  return std::max(0.0, -n.dot(a.move - b.move)) + a.turn + b.turn;
}

// The same in any direction; towards a plane there is but one.
double approach(const Item& a, const Item& b) {
  if (!b.isPlane) return (a.move - b.move).norm() + a.turn + b.turn;
  return approach(a, b, b.R * b.solid.normal);
}

}  // namespace

struct Collider::Impl {
  Pairs pairs;
  std::vector<Found> found;         // the result
  std::vector<Manifold> manifolds;  // and copies of it, where find() was asked
  std::int64_t narrowPhaseCalls = 0;

  struct Step {
    std::span<const Pose> start, end;
    double margin = 0;
  } step;  // that prepare() was given

  // Nothing was found, and along the direction that told them apart they do not come near.
  static bool staysApart(Watch& watch, const Item& a, const Item& b, double near) {
    if (b.solid.kind == SolidKind::triangles) return false;  // no one direction tells them apart
    const Vec3 normal = watch.normal(), n = b.R * normal;
    const double reachA = reachAlong(a.solid, a.R.transpose() * -n);
    const double apart = n.dot(a.x - b.x) - reachA - reachAlong(b.solid, normal);
    if (apart <= near + approach(a, b, n)) return false;
    watch.distance = apart;
    watch.travel = a.travel + b.travel;
    return true;
  }

  // What a pair may have moved by, as a share of its size, and keep its manifold.
  double stillFor(const Item& a, const Item& b, double size) const {
    const double way = kLooksInMotion * ((a.move - b.move).norm() + a.turn + b.turn);
    const double most = std::min(kStillInMotion * size, kStillOfMargin * step.margin);
    return std::max(kStill, std::min(way, most) / size);
  }

  // Whether what was found before still holds for surfaces up to `reach` apart.
  bool holds(const Watch& watch, const Finding& found, const Item& a, const Item& b,
             const Relative& pose, double reach) const {
    const double size = smallerSize(a.solid, b.solid);
    if (reach > watch.reach || !(size > 0)) return false;
    const double still = stillFor(a, b, size);
    return (pose.t - found.pose.t).squaredNorm() <= still * still * size * size &&
           (pose.R - found.pose.R).squaredNorm() <= 2 * still * still;
  }

  // Of a way that short, the present points tell enough of what is at its end.
  static bool isShort(const Item& a, const Item& b, double way) {
    return way <= kShort * std::min(a.solid.thickness, b.solid.thickness);
  }

  static Relative relativePose(const Item& a, const Item& b) {
    const Mat3 toB = b.R.transpose();
    return {toB * a.R, toB * (a.x - b.x)};
  }

  // By how far the two went, what was found before is true of the pair still.
  static bool stays(Watch& watch, const Item& a, const Item& b, double reach, double margin) {
    const double travel = a.travel + b.travel - watch.travel;
    if (watch.count == 0 && watch.distance - travel > reach) return true;
    if (watch.count == 0 && staysApart(watch, a, b, margin)) return true;
    return reach <= watch.reach && travel <= kStill * smallerSize(a.solid, b.solid);
  }

  // From the frames of parts to those of their bodies.
  static void toBodies(const Item& a, const Item& b, Manifold& manifold) {
    if (b.isPart) manifold.normal = b.inBody.q * manifold.normal;
    for (int k = 0; k < manifold.count; ++k) {
      ContactPoint& point = manifold.points[k];
      if (a.isPart) point.coreA = a.inBody.x + a.inBody.q * point.coreA;
      if (b.isPart) point.coreB = b.inBody.x + b.inBody.q * point.coreB;
    }
  }

  // Changes the watch and what belongs to it, and nothing else: pairs may be looked at side by
  // side.
  void look(Watch& watch) {
    const Item &a = pairs.items()[watch.a], &b = pairs.items()[watch.b];
    Finding& found = pairs.finding(watch);
    const double margin = step.margin + std::max(a.push, b.push), reach = margin + approach(a, b);
    watch.calls = 0;
    watch.isNew = false;
    if (watch.known && stays(watch, a, b, reach, margin)) return;
    const Relative pose = relativePose(a, b);
    if (watch.known && holds(watch, found, a, b, pose, reach)) return;
    watch.isNew = watch.known = true;
    watch.travel = a.travel + b.travel;
    watch.reach = reach + kSpare * step.margin;
    found.pose = pose;
    const double near = b.isPlane || isShort(a, b, reach - margin) ? reach : margin;
    if (b.solid.kind == SolidKind::triangles) return lookAtMesh(watch, found, a, b, near, reach);
    const double turn = a.turn + b.turn;
    found.manifold.count = watch.count;
    const Ends ends{a.at(step.end[a.body]), b.at(step.end[b.body])};
    watch.distance = touch(a.solid, b.solid, pose, near, watch.reach, turn, found.manifold, &ends);
    watch.setNormal(found.manifold.normal);
    ++watch.calls;
    const bool onTheWay = watch.distance > near && watch.distance <= reach &&
                          watch.distance <= near + approach(a, b, b.R * watch.normal());
    if (onTheWay) watch.calls += lookAlong(found.manifold, a, b);
    watch.count = static_cast<std::uint8_t>(found.manifold.count);
    watch.known = watch.count == 0 || (!onTheWay && !turnsFar(a.solid, b.solid, turn));
    if (a.isPart || b.isPart) toBodies(a, b, found.manifold);
  }

  // A mesh is touched from several sides at once, and met on the way by one triangle after another.
  void lookAtMesh(Watch& watch, Finding& found, const Item& a, const Item& b, double near,
                  double reach) const {
    MeshLook mesh;
    mesh.pose = found.pose;
    mesh.near = near;
    mesh.reach = watch.reach;
    mesh.isFast = near < reach;
    mesh.way = wayOf(a);
    mesh.wayOfMesh = wayOf(b);
    mesh.approach = approach(a, b);
    mesh.close = closeOf(a, b);
    int calls = 0;
    bool met = false;
    watch.distance = touchMesh(a.solid, b.solid, mesh, found.manifold, found.more, calls, met);
    watch.calls = static_cast<std::uint8_t>(std::min(calls, 255));
    watch.count = static_cast<std::uint8_t>(found.manifold.count);
    watch.more = static_cast<std::uint8_t>(found.more.size());
    watch.known = !met || watch.count == 0;
    toBodies(a, b, found.manifold);
    for (Manifold& manifold : found.more) toBodies(a, b, manifold);
  }

  Way wayOf(const Item& item) const {
    return {item.at(step.start[item.body]), item.at(step.end[item.body])};
  }
  double closeOf(const Item& a, const Item& b) const {
    return std::max(0.1 * step.margin, 1e-4 * smallerSize(a.solid, b.solid));
  }

  // Not near at the start but fast enough to be within the step: the manifold of the first touch,
  // or, when there is none, that of the end. How many evaluations that took.
  std::uint8_t lookAlong(Manifold& manifold, const Item& a, const Item& b) const {
    const Way wayA = wayOf(a), wayB = wayOf(b);
    const double close = closeOf(a, b);
    int calls = 1;
    const double part = firstTouch(a.solid, wayA, b.solid, wayB, close, calls).value_or(1.0);
    const Relative pose = collision::relativePose(along(wayA, part), along(wayB, part));
    const double near = std::max(close, step.margin);
    const double keep = near + (1 - part) * approach(a, b), turn = (1 - part) * (a.turn + b.turn);
    const Ends ends{wayA.end, wayB.end};
    touch(a.solid, b.solid, pose, near, keep, turn, manifold, &ends);
    return static_cast<std::uint8_t>(calls);
  }

  // Watches lie in their order, but bodies in theirs: without this a look waits for memory most of
  // the time.
  void fetchAhead(std::size_t k, std::size_t end) {
    constexpr std::size_t kAhead = 8, kLine = 64;
    const std::vector<Watch>& watches = pairs.watches();
    const auto fetch = [](const void* from, std::size_t bytes) {
      const std::size_t before = reinterpret_cast<std::uintptr_t>(from) % kLine;
      for (std::size_t i = 0; i < before + bytes; i += kLine) {
        __builtin_prefetch(static_cast<const char*>(from) + i);
      }
    };
    if (k + kAhead >= end) return;  // others look at those that follow
    const Watch& watch = watches[k + kAhead];
    constexpr std::size_t kHot = 4 * kLine;  // of an item
    fetch(&pairs.items()[watch.a], kHot);
    fetch(&pairs.items()[watch.b], kHot);
    if (watch.count > 0) fetch(&pairs.finding(watch), sizeof(Relative));
  }

  void lookAt(std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      fetchAhead(k, to);
      look(pairs.watches()[k]);
    }
  }

  void gather() {
    found.clear();
    for (const Watch& watch : pairs.watches()) {
      narrowPhaseCalls += watch.calls;
      if (watch.count == 0) continue;
      const Finding& finding = pairs.finding(watch);
      found.push_back({&finding.manifold, watch.isNew});
      for (int k = 0; k < watch.more; ++k) found.push_back({&finding.more[k], watch.isNew});
    }
  }
};

Collider::Collider() = default;
Collider::~Collider() = default;
Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;

Collider::Impl& Collider::held() {
  if (!impl_) impl_ = std::make_unique<Impl>();
  return *impl_;
}

void Collider::add(BodyId body, const Shape& shape, bool movable) {
  held().pairs.add(body, shape, movable);
}

void Collider::ignore(BodyId a, BodyId b) { held().pairs.ignore(a, b); }
std::span<const std::pair<BodyId, BodyId>> Collider::ignored() const {
  if (!impl_) return {};
  return impl_->pairs.ignored();
}

std::span<const Manifold> Collider::find(std::span<const Pose> start, std::span<const Pose> end,
                                         double margin) {
  Workers alone;
  const std::span<const Found> found = look(start, end, margin, {}, alone);
  if (!impl_) return {};
  impl_->manifolds.clear();
  for (const Found& f : found) impl_->manifolds.push_back(*f.manifold);
  return impl_->manifolds;
}

std::span<const Found> Collider::look(std::span<const Pose> start, std::span<const Pose> end,
                                      double margin, std::span<const double> push,
                                      Workers& workers) {
  constexpr int kLeastPairs = 64;  // of a thread
  require(margin >= 0, "collider: margin must not be negative");
  if (!impl_) return {};
  profileScope("broad_phase");
  Pairs& pairs = impl_->pairs;
  const bool changes = pairs.update(start, end, margin, push, workers);
  impl_->step = {start, end, margin};
  profileScope("narrow_phase");
  const auto lookAt = [&](int from, int to) {
    if (changes && from == 0) {
      profileScope("broad_phase");
      pairs.updateTree();
      profileScope("narrow_phase");
    }
    impl_->lookAt(from, to);
  };
  if (pairs.watches().empty()) lookAt(0, 0);
  workers.forEachChunk(static_cast<int>(pairs.watches().size()), kLeastPairs, lookAt);
  if (changes) {
    profileScope("broad_phase");
    const auto fresh = pairs.findNew(workers);
    profileScope("narrow_phase");
    workers.forEachChunk(static_cast<int>(fresh.size()), kLeastPairs, [&](int from, int to) {
      for (int k = from; k < to; ++k) impl_->look(pairs.watches()[fresh[k]]);
    });
  }
  impl_->gather();
  profileScope("contact");
  return impl_->found;
}

std::span<const Found> Collider::found() const {
  if (!impl_) return {};
  return impl_->found;
}

bool Collider::lookAt(std::uint64_t pair, const Pose& poseA, const Pose& poseB, double near,
                      double turn, Manifold& manifold) const {
  Watch watch;
  std::tie(watch.a, watch.b) = Pairs::itemsOf(pair);
  const Item &a = impl_->pairs.items()[watch.a], &b = impl_->pairs.items()[watch.b];
  if (b.solid.kind == SolidKind::triangles) return false;
  impl_->pairs.name(watch, manifold);
  const Relative pose = collision::relativePose(a.at(poseA), b.at(poseB));
  touch(a.solid, b.solid, pose, near, near, turn, manifold);
  if (a.isPart || b.isPart) Impl::toBodies(a, b, manifold);
  return true;
}

bool Collider::outdated(std::span<const Pose> start, std::span<const Pose> end,
                        std::span<const BodyId> bodies) const {
  return impl_ && impl_->pairs.outdated(start, end, bodies);
}

void Collider::rest(std::span<const BodyId> bodies, std::span<const Pose> poses) {
  held().pairs.rest(bodies, poses);
}
void Collider::wake(std::span<const BodyId> bodies) { held().pairs.wake(bodies); }
bool Collider::canTouch() const { return impl_ && impl_->pairs.canTouch(); }
void Collider::forgetFound() {
  if (!impl_) return;
  for (Watch& watch : impl_->pairs.watches()) {
    watch.known = false;
    watch.count = watch.more = 0;
  }
}
bool Collider::hasShapes() const { return impl_ && !impl_->pairs.items().empty(); }
void Collider::forgetShapes() {
  if (!impl_) return;
  const auto ignored = impl_->pairs.ignored();
  impl_.reset();
  for (const auto& [a, b] : ignored) ignore(a, b);
}

double Collider::distance(BodyId a, const Pose& poseA, BodyId b, const Pose& poseB) const {
  if (!impl_) return std::numeric_limits<double>::infinity();
  const int first = impl_->pairs.indexOf(a), second = impl_->pairs.indexOf(b);
  if (first < 0 || second < 0) return std::numeric_limits<double>::infinity();
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = first; i < impl_->pairs.endOf(first); ++i) {
    for (int j = second; j < impl_->pairs.endOf(second); ++j) {
      const Item &p = impl_->pairs.items()[i], &q = impl_->pairs.items()[j];
      const Relative pose = relativePose(p.at(poseA), q.at(poseB));
      smallest = std::min(smallest, signedDistance(p.solid, q.solid, pose));
    }
  }
  return smallest;
}

double Collider::thickness(BodyId body) const {
  double smallest = std::numeric_limits<double>::infinity();
  if (!impl_) return smallest;
  const int first = impl_->pairs.indexOf(body);
  for (int i = first; i < impl_->pairs.endOf(first); ++i) {
    if (i < 0 || impl_->pairs.items()[i].isPlane) continue;
    smallest = std::min(smallest, impl_->pairs.items()[i].solid.thickness);
  }
  return smallest;
}

Collider::Counts Collider::counts() const {
  if (!impl_) return {};
  return {impl_->narrowPhaseCalls, impl_->pairs.broadPhaseCalls(),
          static_cast<int>(impl_->pairs.watches().size())};
}

// The result of the last look is copied anew from what was found.
void Collider::archive(Archive& a) {
  if (impl_) a(impl_->pairs, impl_->narrowPhaseCalls);
}

std::size_t Collider::bytes() const {
  if (!impl_) return 0;
  return sizeof(Impl) + impl_->pairs.bytes() + impl_->manifolds.capacity() * sizeof(Manifold) +
         impl_->found.capacity() * sizeof(Found);
}

}  // namespace physics
