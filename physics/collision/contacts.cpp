// Candidate points of a touch and their reduction to a manifold.
#include "physics/collision/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace physics::collision {
namespace {

Vec3 tangentTo(const Vec3& n) {
  int smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  return n.cross(Vec3::Unit(smallest)).normalized();
}

// Twice the area of the triangle of three spots; positive: they go round counter-clockwise.
double twiceArea(const Spot& a, const Spot& b, const Spot& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

// What a spot adds to the triangle of three others; negative: it is inside.
double twiceBeyond(const Spot& a, const Spot& b, const Spot& c, const Spot& s) {
  const double turn = twiceArea(a, b, c) > 0 ? 1 : -1;
  const double ab = turn * twiceArea(a, b, s), bc = turn * twiceArea(b, c, s);
  return -std::min({ab, bc, turn * twiceArea(c, a, s)});
}

double way(const Spot& a, const Spot& b) {
  return std::sqrt((b.u - a.u) * (b.u - a.u) + (b.v - a.v) * (b.v - a.v));
}

class Spots {
 public:
  Spots(std::span<const Spot> spots, const Limits& limits) : spots_(spots), limits_(limits) {}

  // One at an end, the furthest from it, the one that spans the largest triangle with these, and
  // the one that adds most to that.
  Choice spread() const {
    constexpr double kNone = -std::numeric_limits<double>::infinity();
    Choice chosen;
    if (!takeLargest(chosen, kNone, limits_.tie, [](const Spot& s) { return s.u + s.v; })) {
      return chosen;
    }
    const Spot& a = at(chosen, 0);
    if (!takeLargest(chosen, 0, limits_.tie, [&](const Spot& s) { return way(a, s); })) {
      return chosen;
    }
    const Spot& b = at(chosen, 1);
    const auto area = [&](const Spot& s) { return std::abs(twiceArea(a, b, s)); };
    if (takeLargest(chosen, 0, limits_.tie * way(a, b), area)) takeBeyond(chosen);
    return chosen;
  }

  // Those that were kept last, and where these are three the one that adds most to them.
  Choice stayed() const {
    Choice chosen;
    for (std::size_t i = 0; i < spots_.size(); ++i) {
      if (!(spots_[i].gap <= limits_.keep) || chosen.count == Manifold::kMaxPoints) continue;
      const auto& before = limits_.before;
      const bool wasKept =
          std::find(before.begin(), before.end(), spots_[i].feature) != before.end();
      if (wasKept) chosen.take(static_cast<int>(i));
    }
    if (chosen.count == 3) takeBeyond(chosen);
    return chosen;
  }

  double twiceAreaOf(const Choice& chosen) const {
    if (chosen.count < 3) return 0;
    const Spot &a = at(chosen, 0), &b = at(chosen, 1), &c = at(chosen, 2);
    const double three = std::abs(twiceArea(a, b, c));
    return chosen.count < 4 ? three : three + std::max(0.0, twiceBeyond(a, b, c, at(chosen, 3)));
  }

 private:
  const Spot& at(const Choice& chosen, int k) const { return spots_[chosen.index[k]]; }

  // The spot of the largest size, and of those as large to `tie` the first. False: all are as none.
  template <class F>
  bool takeLargest(Choice& chosen, double none, double tie, F&& size) const {
    int largest = -1;
    double most = none;
    for (std::size_t i = 0; i < spots_.size(); ++i) {
      if (!(spots_[i].gap <= limits_.keep)) continue;
      const double here = size(spots_[i]);
      if (here > most + tie) most = here, largest = static_cast<int>(i);
    }
    if (largest >= 0) chosen.take(largest);
    return largest >= 0;
  }
  void takeBeyond(Choice& chosen) const {
    const Spot &a = at(chosen, 0), &b = at(chosen, 1), &c = at(chosen, 2);
    takeLargest(chosen, 0, limits_.tie * way(a, b),
                [&](const Spot& s) { return twiceBeyond(a, b, c, s); });
  }

  std::span<const Spot> spots_;
  const Limits& limits_;
};

// The deepest spot, where it is clearly deeper than those chosen: of four it takes the place of the
// one nearest to it, but not that of `stays`. Returned: it.
int insistOnDeepest(std::span<const Spot> spots, double Spot::*gap, int stays, double clearly,
                    Choice& chosen) {
  int deepest = 0;
  for (int i = 1; i < static_cast<int>(spots.size()); ++i) {
    if (spots[i].*gap < spots[deepest].*gap) deepest = i;
  }
  if (chosen.count == 0 || chosen.has(deepest)) return deepest;
  const Spot& deep = spots[deepest];
  int nearest = 0;
  double best = std::numeric_limits<double>::infinity(), lowest = best;
  for (int k = 0; k < chosen.count; ++k) {
    const Spot& spot = spots[chosen.index[k]];
    const double du = spot.u - deep.u, dv = spot.v - deep.v;
    lowest = std::min(lowest, spot.*gap);
    if (chosen.index[k] == stays) continue;
    if (du * du + dv * dv < best) best = du * du + dv * dv, nearest = k;
  }
  if (!(deep.*gap < lowest - clearly)) return deepest;
  if (chosen.count < Manifold::kMaxPoints) {
    chosen.take(deepest);
  } else {
    chosen.index[nearest] = deepest;
  }
  return deepest;
}

}  // namespace

Choice choose(std::span<const Spot> spots, const Limits& limits) {
  const Spots all(spots, limits);
  Choice chosen = all.spread();
  if (spots.size() > Manifold::kMaxPoints && !limits.before.empty()) {
    const Choice stayed = all.stayed();
    if (2 * all.twiceAreaOf(stayed) > all.twiceAreaOf(chosen)) chosen = stayed;
  }
  const int deepest = insistOnDeepest(spots, &Spot::gap, -1, limits.clearly, chosen);
  if (limits.looksAhead(static_cast<int>(spots.size()))) {
    insistOnDeepest(spots, &Spot::ahead, deepest, limits.clearly, chosen);
  }
  return chosen;
}

GapChange::GapChange(const Relative& pose, const Vec3& n, const Ends& ends, Owner owner) {
  const auto& [a, b] = ends;
  if (owner == Owner::b) {
    const Vec3 then = b.q * n;  // world
    slope_ = pose.R * (a.q.conjugate() * then) - n;
    move_ = then.dot(a.x - b.x) - n.dot(pose.t) - slope_.dot(pose.t);
  } else {
    const Vec3 then = a.q * (pose.R.transpose() * n);
    slope_ = n - b.q.conjugate() * then;
    move_ = then.dot(a.x - b.x) - n.dot(pose.t);
  }
}

double offset(const Vec3& n, const Vec3& apart) { return (apart - n.dot(apart) * n).norm(); }

double Contacts::smallestGap() const {
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) smallest = std::min(smallest, points[i].gap);
  return smallest;
}

// Ericson, Real-Time Collision Detection, 5.1.9, with lines of no length allowed.
LinePoints closestPoints(const Line& a, const Line& b) {
  const Vec3 d1 = a.to - a.from, d2 = b.to - b.from, r = a.from - b.from;
  const double aa = d1.squaredNorm(), ee = d2.squaredNorm(), f = d2.dot(r), c = d1.dot(r);
  double s = 0, t = 0;
  if (aa > 0 && ee > 0) {
    const double bb = d1.dot(d2);
    const double square = d1.cross(d2).squaredNorm();
    s = square > 1e-20 * aa * ee ? std::clamp((bb * f - c * ee) / square, 0.0, 1.0) : 0.0;
    t = (bb * s + f) / ee;
    if (t < 0 || t > 1) {
      t = std::clamp(t, 0.0, 1.0);
      s = std::clamp((bb * t - c) / aa, 0.0, 1.0);
    }
  } else if (aa > 0) {
    s = std::clamp(-c / aa, 0.0, 1.0);
  } else if (ee > 0) {
    t = std::clamp(f / ee, 0.0, 1.0);
  }
  return {a.from + s * d1, b.from + t * d2};
}

Facet facetInB(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int index) {
  if (owner == Owner::b) return facet(b, index);
  Facet plane = facet(a, index);
  plane.normal = pose.R * plane.normal;
  plane.offset += plane.normal.dot(pose.t);
  return plane;
}

void layOnFacet(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int index,
                const Vec3& outwards, double tolerance, Patch& other) {
  Patch flat;
  facetPatch(owner == Owner::a ? a : b, index, flat);
  if (owner == Owner::a) {
    transform(flat, pose);
    facing(b, -outwards, other);
  } else {
    facing(a, -(pose.R.transpose() * outwards), other);
    transform(other, pose);
  }
  clip(other, flat, outwards, tolerance);
}

void touchFacet(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int index,
                Contacts& contacts) {
  const Facet plane = facetInB(a, b, pose, owner, index);
  Patch other;
  layOnFacet(a, b, pose, owner, index, plane.normal, kSideTolerance * std::min(a.size, b.size),
             other);
  contacts.n = owner == Owner::a ? Vec3(-plane.normal) : plane.normal;
  contacts.radiusA = owner == Owner::a ? 0 : other.radius;
  contacts.radiusB = owner == Owner::a ? other.radius : 0;
  contacts.count = 0;
  for (int i = 0; i < other.count; ++i) {
    const Vec3& p = other.corners[i].p;
    const Vec3 onPlane = p - (plane.normal.dot(p) - plane.offset) * plane.normal;
    const std::uint32_t feature = facetFeature(owner, index, other.corners[i].id);
    contacts.add(owner == Owner::a ? onPlane : p, owner == Owner::a ? p : onPlane, feature);
  }
}

void touchLines(const Line& a, const Line& b, std::uint32_t feature, double flatness,
                Contacts& contacts) {
  const LinePoints closest = closestPoints(a, b);
  contacts.count = 0;
  contacts.add(closest.onA, closest.onB, feature);
  const Vec3 along = b.to - b.from, other = a.to - a.from;
  const double square = along.squaredNorm();
  const double first = along.dot(a.from - b.from), rise = along.dot(other);
  if (!(square > 0) || rise == 0) return;
  // The stretch of b beside a, in parts of b.
  const double low = std::clamp(std::min(first, first + rise) / square, 0.0, 1.0);
  const double high = std::clamp(std::max(first, first + rise) / square, 0.0, 1.0);
  if (!((high - low) * std::sqrt(square) > 4 * flatness)) return;
  const double radii = a.rounding + b.rounding, shareB = radii > 0 ? b.rounding / radii : 0;
  int flat = 0;
  for (const double part : {low, high}) {
    const Vec3 onA = a.from + (part * square - first) / rise * other, onB = b.from + part * along;
    const Vec3 apart = onA - onB, beside = apart - contacts.n.dot(apart) * contacts.n;
    const bool isFlat = beside.norm() <= flatness;
    // Where round sides face each other along n, between the two lines: below their tops.
    const double below = radii - std::sqrt(radii * radii - beside.squaredNorm());
    const bool meet = radii > 0 ? below >= 0 : isFlat;
    if (!meet) continue;
    const Vec3 way = radii > 0 ? Vec3(beside - below * contacts.n) : Vec3::Zero();
    contacts.add(onA - (1 - shareB) * way, onB + shareB * way, feature + (part == low ? 1 : 2));
    flat += isFlat;
  }
  if (flat == 2) contacts.points[0] = contacts.points[--contacts.count];
}

void finish(const Contacts& contacts, const Relative& pose, const Limits& limits, Manifold& out) {
  const Vec3 t1 = tangentTo(contacts.n), t2 = contacts.n.cross(t1);
  std::array<Spot, Patch::kRoom> spots;
  for (int i = 0; i < contacts.count; ++i) {
    const Candidate& point = contacts.points[i];
    spots[i] = {point.onA.dot(t1), point.onA.dot(t2), point.gap, point.gap, point.feature};
  }
  if (limits.looksAhead(contacts.count)) {
    const GapChange change(pose, contacts.n, *limits.ends, Owner::b);
    for (int i = 0; i < contacts.count; ++i) spots[i].ahead += change.of(contacts.points[i].onA);
  }
  Choice chosen = choose({spots.data(), static_cast<std::size_t>(contacts.count)}, limits);
  chosen.sort([&](int i) { return contacts.points[i].feature; });
  out.normal = contacts.n;
  out.count = chosen.count;
  for (int k = 0; k < chosen.count; ++k) {
    const Candidate& from = contacts.points[chosen.index[k]];
    ContactPoint& point = out.points[k];
    point.coreA = pose.R.transpose() * (from.onA - pose.t);
    point.coreB = from.onB;
    point.radiusA = contacts.radiusA;
    point.radiusB = contacts.radiusB;
    point.feature = from.feature;
  }
}

}  // namespace physics::collision
