// Candidate points of a touch and their reduction to a manifold.
#include "physics/collision/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace physics::collision {
namespace {

constexpr double kSideTolerance = 1e-4;  // of the smaller size: aligned edges do not flicker

std::uint32_t facetFeature(Owner owner, int index, std::uint32_t id) {
  return kFacetTag | (owner == Owner::a ? 1u << 31 : 0u) |
         (static_cast<std::uint32_t>(index) & 0xfff) << 17 | id;
}

// Chosen points so far; `take` moves candidate i into the choice.
struct Choice {
  std::array<int, Manifold::kMaxPoints> index{};
  int count = 0;
  void take(int i) { index[count++] = i; }
  bool has(int i) const {
    return std::find(index.begin(), index.begin() + count, i) != index.begin() + count;
  }
};

Vec3 tangentTo(const Vec3& n) {
  int smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  return n.cross(Vec3::Unit(smallest)).normalized();
}

// The furthest candidates along the four diagonals of the plane of touch: the corners of an upright
// face. They do not depend on the gaps, so that the choice stays while a body settles.
Choice spread(const Contacts& c, double keep, double tie) {
  const Vec3 t1 = tangentTo(c.n), t2 = c.n.cross(t1);
  Choice chosen;
  for (const Vec3& d : {Vec3(t1 + t2), Vec3(t1 - t2), Vec3(-t1 - t2), Vec3(t2 - t1)}) {
    int winner = -1;
    double most = 0;
    for (int i = 0; i < c.count; ++i) {
      if (!(c.points[i].gap <= keep)) continue;
      const double value = c.points[i].onA.dot(d);
      if (winner < 0 || value > most + tie) winner = i, most = value;
    }
    if (winner >= 0 && !chosen.has(winner)) chosen.take(winner);
  }
  return chosen;
}

// The deepest candidate takes the place of the chosen point nearest to it, where it is clearly
// deeper.
void insistOnDeepest(const Contacts& c, double clearly, Choice& chosen) {
  int deepest = 0;
  for (int i = 1; i < c.count; ++i) {
    if (c.points[i].gap < c.points[deepest].gap) deepest = i;
  }
  if (chosen.count == 0 || chosen.has(deepest)) return;
  int nearest = 0;
  double best = std::numeric_limits<double>::infinity(), lowest = best;
  for (int k = 0; k < chosen.count; ++k) {
    const Candidate& point = c.points[chosen.index[k]];
    const double distance = (point.onA - c.points[deepest].onA).squaredNorm();
    if (distance < best) best = distance, nearest = k;
    lowest = std::min(lowest, point.gap);
  }
  if (c.points[deepest].gap < lowest - clearly) chosen.index[nearest] = deepest;
}

Choice choose(const Contacts& c, double keep, double tie, double clearly) {
  Choice chosen = spread(c, keep, tie);
  insistOnDeepest(c, clearly, chosen);
  return chosen;
}

}  // namespace

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

void touchFacet(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int index,
                Contacts& contacts) {
  Patch flat, other;
  Facet plane = facet(owner == Owner::a ? a : b, index);
  facetPatch(owner == Owner::a ? a : b, index, flat);
  if (owner == Owner::a) {
    transform(flat, pose);
    plane.normal = pose.R * plane.normal;
    plane.offset += plane.normal.dot(pose.t);
    facing(b, -plane.normal, other);
  } else {
    facing(a, -(pose.R.transpose() * plane.normal), other);
    transform(other, pose);
  }
  clip(other, flat, plane.normal, kSideTolerance * std::min(a.size, b.size));
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
  contacts.count = 0;
  const Vec3 along = b.to - b.from, other = a.to - a.from;
  const double square = along.squaredNorm();
  const double first = along.dot(a.from - b.from), rise = along.dot(other);
  if (square > 0 && rise != 0) {  // the stretch of b beside a, in parts of b
    const double low = std::clamp(std::min(first, first + rise) / square, 0.0, 1.0);
    const double high = std::clamp(std::max(first, first + rise) / square, 0.0, 1.0);
    if ((high - low) * std::sqrt(square) > 4 * flatness) {
      for (const double part : {low, high}) {
        const Vec3 onA = a.from + (part * square - first) / rise * other,
                   onB = b.from + part * along;
        if (offset(contacts.n, onA - onB) > flatness) continue;
        contacts.add(onA, onB, feature + (part == low ? 0u : 1u));
      }
    }
  }
  if (contacts.count == 2) return;
  contacts.count = 0;
  const LinePoints closest = closestPoints(a, b);
  contacts.add(closest.onA, closest.onB, feature);
}

void finish(const Contacts& contacts, const Relative& pose, double keep, double tie, double clearly,
            Manifold& out) {
  Choice chosen = choose(contacts, keep, tie, clearly);
  for (int k = 1; k < chosen.count; ++k) {  // by feature
    for (int l = k; l > 0; --l) {
      int &p = chosen.index[l - 1], &q = chosen.index[l];
      if (contacts.points[q].feature < contacts.points[p].feature) std::swap(p, q);
    }
  }
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
