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

// Twice the area of the triangle p q r seen along n, with sign.
double area(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& n) {
  return n.dot((q - p).cross(r - p));
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

// The candidate of `among` with the largest score above `least`; the earlier one within `tie`.
template <typename Score>
int best(const Contacts& c, double keep, double tie, double least, const Choice& chosen,
         const Score& score) {
  int winner = -1;
  double most = least;
  for (int i = 0; i < c.count; ++i) {
    if (!(c.points[i].gap <= keep) || chosen.has(i)) continue;
    const double value = score(c.points[i]);
    if (value > most + (winner < 0 ? 0 : tie)) {
      winner = i;
      most = value;
    }
  }
  return winner;
}

Choice choose(const Contacts& c, double keep, double tie) {
  Choice chosen;
  const double lowest = -std::numeric_limits<double>::infinity();
  const auto at = [&](int k) -> const Vec3& { return c.points[chosen.index[k]].onA; };
  const auto take = [&](double least, double slack, const auto& score) {
    const int i = best(c, keep, slack, least, chosen, score);
    if (i >= 0) chosen.take(i);
    return i >= 0;
  };
  if (!take(lowest, tie, [](const Candidate& p) { return -p.gap; })) return chosen;
  if (!take(tie, tie, [&](const Candidate& p) { return (p.onA - at(0)).norm(); })) return chosen;
  const double width = (at(1) - at(0)).norm();
  const double thin = tie * width;
  if (!take(thin, thin,
            [&](const Candidate& p) { return std::abs(area(at(0), at(1), p.onA, c.n)); }))
    return chosen;
  // Counter-clockwise, the fourth adds most area beyond one of the three sides.
  if (area(at(0), at(1), at(2), c.n) < 0) std::swap(chosen.index[1], chosen.index[2]);
  take(thin, thin, [&](const Candidate& p) {
    return std::max({-area(at(0), at(1), p.onA, c.n), -area(at(1), at(2), p.onA, c.n),
                     -area(at(2), at(0), p.onA, c.n)});
  });
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

void finish(const Contacts& contacts, const Relative& pose, double keep, double tie,
            Manifold& out) {
  Choice chosen = choose(contacts, keep, tie);
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
