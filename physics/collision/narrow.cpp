// Dispatch over pairs of shapes, and the general method for convex cores.
#include "physics/collision/narrow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/collision/axis.h"
#include "physics/collision/box_face.h"
#include "physics/collision/contacts.h"
#include "physics/collision/gjk.h"
#include "physics/collision/mesh_contacts.h"
#include "physics/collision/round.h"

namespace physics::collision {
namespace {

constexpr double kRimDeeper = 1e-4;  // a rim has no corners to keep to
// Of the way that corners turn by until the next look: half of it on the average, at half of their
// reach. What faces is as near as what is nearest now if it is further by no more.
constexpr double kShareOfTurn = 0.25;
// Cosine of 0.3 rad, which nothing resolved turns by until the next look. Without it heaps cost 2
// to 5 % more and are held no better.
constexpr double kFacing = 0.95;
// Of the smaller size: a corner that is cut this near to where lines touch is that place again.
constexpr double kSamePlace = 4 * kSideTolerance;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

Line placed(const Line& line, const Relative& pose) {
  return {pose.R * line.from + pose.t, pose.R * line.to + pose.t, line.rounding};
}

// Beside lines that touch, the faces along them: bodies that turn a little until the next look meet
// there. What one turns towards the face of the other that looks along n the most, with its gaps
// along n.
void addFacing(const Solid& a, const Solid& b, const Relative& pose, Contacts& contacts) {
  const Vec3& n = contacts.n;
  const int lines = contacts.count;
  const double size = smallerSize(a, b);
  Owner owner = Owner::b;
  int index = -1;
  double cosine = kFacing;
  const auto offer = [&](Owner of, const Solid& solid, const Vec3& along) {
    if (!solid.isPolyhedron()) return;
    const int nearest = nearestFace(solid, along);
    const double here = facet(solid, nearest).normal.dot(along);
    if (here > cosine) owner = of, index = nearest, cosine = here;
  };
  offer(Owner::b, b, n);
  offer(Owner::a, a, -(pose.R.transpose() * n));
  if (index < 0) return;
  const Facet face = facetInB(a, b, pose, owner, index);
  const Vec3 outwards = owner == Owner::a ? Vec3(-n) : n;
  Patch other;
  layOnFacet(a, b, pose, owner, index, outwards, -kSideTolerance * size, other);
  for (int i = 0; i < other.count && contacts.count < Patch::kRoom; ++i) {
    const Vec3& p = other.corners[i].p;
    bool isKnown = false;
    for (int k = 0; k < lines; ++k) {
      isKnown = isKnown || offset(n, p - contacts.points[k].onA) <= kSamePlace * size;
    }
    if (isKnown) continue;
    const double height = (face.normal.dot(p) - face.offset) / cosine;
    const std::uint32_t feature = facetFeature(owner, index, other.corners[i].id);
    const Vec3 onFace = p - height * outwards;
    contacts.add(owner == Owner::a ? onFace : p, owner == Owner::a ? p : onFace, feature);
  }
}

// Points for a direction found among facets and lines.
void touchAlong(const Solid& a, const Solid& b, const Relative& pose, const Axis& axis,
                double tolerance, Contacts& contacts) {
  if (axis.from == Axis::From::facetB) {
    touchFacet(a, b, pose, Owner::b, axis.indexB, contacts);
  } else if (axis.from == Axis::From::facetA) {
    touchFacet(a, b, pose, Owner::a, axis.indexA, contacts);
  } else {
    contacts.n = axis.n;
    contacts.radiusA = a.isLine() ? a.radius : 0;
    contacts.radiusB = b.isLine() ? b.radius : 0;
    const auto edges = static_cast<std::uint32_t>(axis.indexA * 4096 + axis.indexB) * 4;
    touchLines(placed(lineOf(a, axis.indexA), pose), lineOf(b, axis.indexB), kLinesTag | edges,
               flatness(a, b), contacts);
    const Vec3 apart = contacts.points[0].onA - contacts.points[0].onB;  // beyond an end of a line
    if (offset(axis.n, apart) > flatness(a, b)) contacts.count = 0;
    if (contacts.count > 0 && contacts.points[0].gap <= tolerance) addFacing(a, b, pose, contacts);
  }
}

// One point between two core points.
void touchPoints(const Solid& a, const Solid& b, const Vec3& n, const Vec3& onA, const Vec3& onB,
                 Contacts& contacts) {
  contacts.n = n;
  contacts.radiusA = a.rounding;
  contacts.radiusB = b.rounding;
  contacts.count = 0;
  contacts.add(onA, onB, kPointTag);
}

// A better start than `axis` among a grid of directions and the way from centre to centre.
void startSearch(const Solid& a, const Solid& b, const Relative& pose, Axis& axis) {
  const auto offer = [&](const Vec3& d) {
    const Vec3 n = d.normalized();
    const double separation = separationAlong(a, b, pose, n);
    if (separation > axis.separation) axis = {Axis::From::points, n, separation, -1, -1};
  };
  if (pose.t.squaredNorm() > 0) offer(pose.t);
  for (int i = 0; i < 27; ++i) {
    if (i != 13) offer(Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
  }
}

// Overlapping cores with a curved side or too many edges: pushed apart along the best direction
// known, their distance gives a better one, until it does not. True when it found one better by
// `tolerance`.
bool refine(const Solid& a, const Solid& b, const Relative& pose, double tolerance, Axis& axis,
            Contacts& contacts) {
  Axis best = axis;
  startSearch(a, b, pose, best);
  for (int i = 0; i < 20; ++i) {
    const double away = 1e-2 * smallerSize(a, b) - best.separation;
    Relative apart = pose;
    apart.t += away * best.n;
    const Distance d = coreDistance(a, b, apart);
    if (d.overlap) break;
    const Vec3 n = (d.onA - d.onB).normalized();
    const double separation = d.distance - away * best.n.dot(n);
    const Vec3 middle = 0.5 * (d.onA - away * best.n + d.onB);
    const double gain = separation - best.separation;
    if (i > 0 && gain < -1e-12 * smallerSize(a, b)) break;
    touchPoints(a, b, n, middle + 0.5 * separation * n, middle - 0.5 * separation * n, contacts);
    best = {Axis::From::points, n, separation, -1, -1};
    if (gain <= 1e-12 * smallerSize(a, b)) break;
  }
  if (best.separation <= axis.separation + tolerance) return false;
  axis = best;
  return true;
}

bool isExact(const Solid& a, const Solid& b) {  // facets and edges are all there is
  const bool curved = a.kind == SolidKind::cylinder || b.kind == SolidKind::cylinder;
  return !curved && !tooManyEdges(a, b);
}

// Cores that overlap, or touch to rounding. `contacts`: of a facet or line, which may not hold the
// deepest point.
double touchOverlapping(const Solid& a, const Solid& b, const Relative& pose, Axis axis,
                        Contacts& contacts) {
  const double tolerance = kFlat * smallerSize(a, b);
  Contacts refined;
  if (!isExact(a, b) && refine(a, b, pose, tolerance, axis, refined)) {
    contacts = refined;
  } else if (contacts.smallestGap() > axis.separation - a.rounding - b.rounding + tolerance) {
    touchParting(a, b, pose, axis.n, axis.separation, contacts);
  }
  return axis.separation - a.rounding - b.rounding;
}

// Separations that differ by less are one: corners may turn by `turn` until the next look.
double toleranceOf(const Solid& a, const Solid& b, double turn) {
  return std::max(kFlat * smallerSize(a, b), kShareOfTurn * turn);
}

// Two cores with facets and edges. A facet or line is taken when one of its points is at the
// distance that the directions promise; then no other can be nearer. Otherwise the nearest points
// decide. `faceTried`: touchBoxFace() would not have the preferred one, if that is a facet.
double touchCores(const Solid& a, const Solid& b, const Relative& pose, const Axes& axes,
                  double tolerance, bool faceTried, Contacts& contacts) {
  const double radii = a.rounding + b.rounding;
  const Axis& largest = axes.largest();
  const double separation = largest.separation - radii;
  const Axis& preferred = axes.preferred(tolerance);
  const bool exact = isExact(a, b);
  for (const Axis* axis : {&preferred, &largest}) {
    if (faceTried && axis == &preferred && axis->from != Axis::From::lines) continue;
    touchAlong(a, b, pose, *axis, tolerance, contacts);
    if (exact && largest.separation <= 0 && contacts.count > 0) return separation;
    if (!exact && largest.separation < -tolerance) continue;
    if (contacts.smallestGap() <= separation + tolerance) return separation;
  }
  const Distance nearest = coreDistance(a, b, pose);
  if (nearest.overlap) return touchOverlapping(a, b, pose, largest, contacts);
  const Vec3 n = (nearest.onA - nearest.onB).normalized();
  touchPoints(a, b, n, nearest.onA, nearest.onB, contacts);
  return nearest.distance - radii;
}

// The most frequent case of touchCores(), by the same rules, in the frame of the face.
bool touchBoxFace(const Solid& a, const Solid& b, const Relative& pose, const Axes& axes,
                  double tolerance, const Limits& limits, Manifold& out) {
  const double separation = axes.largest().separation;
  const Axis& axis = axes.preferred(tolerance);
  if (axis.from == Axis::From::lines) return false;
  const bool ofA = axis.from == Axis::From::facetA;
  FacePoints points;
  layOnFace(a, b, pose, ofA ? Owner::a : Owner::b, ofA ? axis.indexA : axis.indexB, points);
  const double gap = separation - a.rounding - b.rounding;
  if (points.count == 0 || (separation > 0 && points.smallestGap() > gap + tolerance)) return false;
  finish(a, b, pose, points, limits, out);
  return true;
}

// Over a plane, of the lowest point: the manifold has it to within its tolerance only.
double heightOver(const Solid& a, const Solid& plane, const Relative& pose) {
  const Vec3 low = support(a, -(pose.R.transpose() * plane.normal));
  return plane.normal.dot(pose.R * low + pose.t) - plane.offset - a.rounding;
}

bool isRound(const Solid& s) { return s.kind <= SolidKind::capsule; }
bool isBoxy(const Solid& a, const Solid& b) {
  return b.kind == SolidKind::box && (a.kind == SolidKind::box || a.kind == SolidKind::capsule);
}

}  // namespace

bool turnsFar(const Solid& a, const Solid& b, double turn) {
  return toleranceOf(a, b, turn) > toleranceOf(a, b, 0);
}

void touchParting(const Solid& a, const Solid& b, const Relative& pose, const Vec3& n,
                  double separation, Contacts& contacts) {
  const double away = 1e-2 * smallerSize(a, b) - separation;
  Relative apart = pose;
  apart.t += away * n;
  const Distance d = coreDistance(a, b, apart);
  Vec3 onA = pose.R * support(a, -(pose.R.transpose() * n)) + pose.t, onB = onA;
  if (!d.overlap) onA = d.onA - away * n, onB = d.onB;
  const Vec3 middle = 0.5 * (onA + onB);
  const Vec3 half = 0.5 * separation * n;
  touchPoints(a, b, n, d.overlap ? onA : Vec3(middle + half),
              d.overlap ? Vec3(onA - 2 * half) : Vec3(middle - half), contacts);
}

double touch(const Solid& a, const Solid& b, const Relative& pose, double reach, double keep,
             double turn, Manifold& out, const Ends* ends) {
  const double size = smallerSize(a, b);
  const bool rim = a.kind == SolidKind::cylinder || b.kind == SolidKind::cylinder;
  std::array<std::uint32_t, Manifold::kMaxPoints> before;
  for (int k = 0; k < out.count; ++k) before[k] = out.points[k].feature;
  const Limits limits{keep, kTie * size, (rim ? kRimDeeper : kDeeper) * size,
                      std::span(before).first(out.count), ends};
  out.count = 0;
  Contacts contacts;
  double distance = 0;
  if (b.kind == SolidKind::plane) {
    distance = touchPlane(a, b, pose, contacts);
  } else if (isRound(b)) {
    distance = touchRound(a, b, pose, reach, contacts);
  } else if (a.kind <= SolidKind::sphere) {
    distance = touchPoint(a, b, pose, contacts);
  } else {
    const double radii = a.rounding + b.rounding, tolerance = toleranceOf(a, b, turn);
    const bool boxy = isBoxy(a, b);
    const Axes axes = (boxy ? findBoxAxes : findAxes)(a, b, pose, keep + radii);
    const double separation = axes.largest().separation - radii;
    out.normal = axes.largest().n;
    if (separation > reach) return separation;
    if (boxy && touchBoxFace(a, b, pose, axes, tolerance, limits, out)) return separation;
    distance = touchCores(a, b, pose, axes, tolerance, boxy, contacts);
  }
  out.normal = contacts.n;
  if (distance <= reach) finish(contacts, pose, limits, out);
  return distance;
}

Apart apart(const Solid& a, const Solid& b, const Relative& pose) {
  if (b.isSheet) {
    const Distance nearest = coreDistance(a, b, pose);
    if (nearest.overlap) return {-a.rounding, Vec3::UnitY()};
    return {nearest.distance - a.rounding, (nearest.onA - nearest.onB).normalized()};
  }
  if (isBoxy(a, b)) {
    const Axes axes = findBoxAxes(a, b, pose, kInfinite);
    return {axes.largest().separation - a.rounding, axes.largest().n};
  }
  Manifold manifold;
  const double distance = touch(a, b, pose, kInfinite, kInfinite, 0, manifold);
  return {distance, manifold.normal};
}

double signedDistance(const Solid& a, const Solid& b, const Relative& pose) {
  if (a.kind > b.kind) return signedDistance(b, a, inverse(pose));
  if (b.kind == SolidKind::triangles)
    return a.kind >= SolidKind::plane ? kInfinite : meshDistance(a, b, pose);
  Contacts contacts;
  if (b.kind == SolidKind::plane) return a.kind == b.kind ? kInfinite : heightOver(a, b, pose);
  if (isRound(b)) return touchRound(a, b, pose, -kInfinite, contacts);
  if (a.kind <= SolidKind::sphere) return touchPoint(a, b, pose, contacts);
  const double radii = a.rounding + b.rounding;
  const Distance nearest = coreDistance(a, b, pose);
  if (!nearest.overlap) return nearest.distance - radii;
  Axis best = findAxes(a, b, pose, kInfinite).largest();
  if (!isExact(a, b)) refine(a, b, pose, 0, best, contacts);
  return best.separation - radii;
}

}  // namespace physics::collision
