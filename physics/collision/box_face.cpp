// Clipping against a rectangle, and the way back to body frames.
#include "physics/collision/box_face.h"

#include <algorithm>
#include <cmath>

namespace physics::collision {
namespace {

using Corner = FacePoints::Corner;

// A face of a box: its normal is `sign` times axis k, and u and v run along the next two axes.
struct Frame {
  int k, u, v;
  double sign, height;

  Frame(const Solid& box, int face)
      : k(face / 2), u((k + 1) % 3), v((k + 2) % 3), sign(face % 2 ? 1 : -1), height(box.half[k]) {}
  Spot spot(const Vec3& p) const { return {p[u], p[v], sign * p[k] - height, 0, 0}; }
  Vec3 point(const Spot& spot, double gap) const {
    Vec3 p;
    p[u] = spot.u;
    p[v] = spot.v;
    p[k] = sign * (height + gap);
    return p;
  }
};

// What faces the box: the face of another box nearest to d (the incident's frame), or a segment.
void placeIncident(const Solid& s, const Relative& toFace, const Vec3& d, const Frame& frame,
                   FacePoints& points) {
  const auto add = [&](const Vec3& p, int id) {
    const auto corner = static_cast<std::uint32_t>(id);
    points.corners[points.count++] = {frame.spot(toFace.R * p + toFace.t), corner, corner};
  };
  points.count = 0;
  if (s.isLine()) {
    add(-s.half, 0);
    if (s.halfLength > 0) add(s.half, 1);
    return;
  }
  for (const int id : kBoxFaces[nearestFace(s, d)]) add(cornerOf(s, id), id);
}

Corner cut(const Corner& from, const Corner& to, double fromOut, double toOut, int side) {
  const double part = fromOut / (fromOut - toOut);
  const auto between = [&](double p, double q) { return p + part * (q - p); };
  return {{between(from.spot.u, to.spot.u), between(from.spot.v, to.spot.v),
           between(from.spot.gap, to.spot.gap), 0, 0},
          cutId(from.edge, static_cast<std::uint32_t>(side)),
          from.edge};
}

// Keeps what is inside of one side: Sutherland and Hodgman. `out` is the distance outside.
void cutPolygon(FacePoints& points, const std::array<double, FacePoints::kRoom>& out, int side) {
  std::array<Corner, FacePoints::kRoom> before;
  const int count = points.count;
  std::copy_n(points.corners.begin(), count, before.begin());
  points.count = 0;
  for (int i = 0; i < count; ++i) {
    const int next = i + 1 < count ? i + 1 : 0;
    if (out[i] <= 0) points.corners[points.count++] = before[i];
    if ((out[i] <= 0) == (out[next] <= 0)) continue;
    Corner& corner = points.corners[points.count++];
    corner = cut(before[i], before[next], out[i], out[next], side);
    if (out[i] <= 0) corner.edge = sideId(static_cast<std::uint32_t>(side));
  }
}

void cutSegment(FacePoints& points, const std::array<double, FacePoints::kRoom>& out, int side) {
  Corner &first = points.corners[0], &last = points.corners[1];
  if (out[0] > 0 && out[1] > 0) {
    points.count = 0;
  } else if (out[0] > 0) {
    first = cut(first, last, out[0], out[1], side);
  } else {
    last = cut(first, last, out[0], out[1], side);
    last.id = otherCut(last.id);
  }
}

// `side` k of a face runs from its corner k to the next.
void cutSide(FacePoints& points, const Solid& box, const Frame& frame, int side, double tolerance) {
  const auto& corners = kBoxFaces[2 * frame.k + (frame.sign > 0 ? 1 : 0)];
  const int from = corners[side], to = corners[(side + 1) % 4];
  const bool alongU = ((from ^ to) >> frame.u & 1) != 0;
  const int axis = alongU ? frame.v : frame.u;
  const double sign = from >> axis & 1 ? 1 : -1, limit = box.half[axis] + tolerance;
  std::array<double, FacePoints::kRoom> out;
  bool cuts = false;
  for (int i = 0; i < points.count; ++i) {
    const Spot& spot = points.corners[i].spot;
    out[i] = sign * (alongU ? spot.v : spot.u) - limit;
    cuts = cuts || out[i] > 0;
  }
  if (!cuts) return;
  if (points.count > 2) {
    cutPolygon(points, out, side);
  } else if (points.count == 2) {
    cutSegment(points, out, side);
  } else {
    points.count = 0;
  }
}

}  // namespace

double FacePoints::smallestGap() const {
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) smallest = std::min(smallest, corners[i].spot.gap);
  return smallest;
}

void layOnFace(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int face,
               FacePoints& points) {
  const Solid &flat = owner == Owner::a ? a : b, &other = owner == Owner::a ? b : a;
  const Relative toFace = owner == Owner::a ? inverse(pose) : pose;
  const Frame frame(flat, face);
  points.owner = owner;
  points.face = face;
  placeIncident(other, toFace, -frame.sign * toFace.R.row(frame.k).transpose(), frame, points);
  const double tolerance = kSideTolerance * std::min(a.size, b.size);
  for (int side = 0; side < 4; ++side) cutSide(points, flat, frame, side, tolerance);
  for (int i = 0; i < points.count; ++i) points.corners[i].spot.gap -= other.rounding;
}

void finish(const Solid& a, const Solid& b, const Relative& pose, const FacePoints& points,
            const Limits& limits, Manifold& out) {
  const bool ofA = points.owner == Owner::a;
  const Solid &flat = ofA ? a : b, &other = ofA ? b : a;
  const Frame frame(flat, points.face);
  std::array<Spot, FacePoints::kRoom> spots;
  for (int i = 0; i < points.count; ++i) {
    spots[i] = points.corners[i].spot;
    spots[i].feature = facetFeature(points.owner, points.face, points.corners[i].id);
  }
  out.normal =
      ofA ? Vec3(-frame.sign * pose.R.col(frame.k)) : Vec3(frame.sign * Vec3::Unit(frame.k));
  if (limits.looksAhead(points.count)) {
    const GapChange change(pose, out.normal, *limits.ends, points.owner);
    for (int i = 0; i < points.count; ++i) {
      const Vec3 p = frame.point(spots[i], spots[i].gap + other.rounding);
      spots[i].ahead = spots[i].gap + change.of(ofA ? Vec3(pose.R * p + pose.t) : p);
    }
  }
  Choice chosen = choose({spots.data(), static_cast<std::size_t>(points.count)}, limits);
  chosen.sort([&](int i) { return spots[i].feature; });
  out.count = chosen.count;
  for (int k = 0; k < chosen.count; ++k) {
    const Corner& corner = points.corners[chosen.index[k]];
    const Vec3 p = frame.point(corner.spot, corner.spot.gap + other.rounding);
    const Vec3 onOther = ofA ? Vec3(pose.R * p + pose.t) : Vec3(pose.R.transpose() * (p - pose.t));
    const Vec3 onFlat = frame.point(corner.spot, 0);
    ContactPoint& point = out.points[k];
    point.coreA = ofA ? onFlat : onOther;
    point.coreB = ofA ? onOther : onFlat;
    point.radiusA = ofA ? 0 : other.rounding;
    point.radiusB = 0;
    point.feature = spots[chosen.index[k]].feature;
  }
}

}  // namespace physics::collision
