// Making and clipping of patches.
#include "physics/collision/patch.h"

#include <algorithm>
#include <cmath>

namespace physics::collision {
namespace {

constexpr int kRim = 16;  // edges are within the rim by 1 - cos(pi/16), 2 % of the radius
constexpr double kCos[5] = {1, 0.92387953251128674, 0.70710678118654752, 0.38268343236508977, 0};

// cos(2 pi k / kRim), the same bits everywhere.
double rimCosine(int k) {
  k &= kRim - 1;
  if (k > 8) k = kRim - k;
  return k <= 4 ? kCos[k] : -kCos[8 - k];
}
Vec3 rimDirection(int k) { return {rimCosine(k), 0, rimCosine(k + kRim / 4 * 3)}; }

// Counter-clockwise seen from outside. When the cap is tilted the corner nearest to d is moved to
// the rim point furthest along d.
void capPatch(const Solid& s, bool top, const Vec3& d, Patch& patch) {
  const double across = std::sqrt(d.x() * d.x() + d.z() * d.z());
  int nearest = -1;
  if (across > 1e-3) {
    nearest = 0;
    for (int k = 1; k < kRim; ++k) {
      if (rimDirection(k).dot(d) > rimDirection(nearest).dot(d)) nearest = k;
    }
  }
  patch.count = 0;
  patch.radius = 0;
  for (int i = 0; i < kRim; ++i) {
    const int k = top ? kRim - 1 - i : i;
    Vec3 p = s.radius * (k == nearest ? Vec3(d.x() / across, 0, d.z() / across) : rimDirection(k));
    p.y() = top ? s.halfLength : -s.halfLength;
    patch.add(p, static_cast<std::uint32_t>(k));
  }
}

// The two rim points furthest along d. Their cores are drawn back along d onto the axis (when d is
// square to it), so that a rolling cylinder keeps its gap.
void sidePatch(const Solid& s, const Vec3& d, Patch& patch) {
  const double across = std::sqrt(d.x() * d.x() + d.z() * d.z());
  patch.count = 0;
  patch.radius = s.radius * across;
  Vec3 core = Vec3(d.x(), 0, d.z()) * (s.radius / across) - patch.radius * d;
  const double y = core.y();
  core.y() = y - s.halfLength;
  patch.add(core, 0);
  core.y() = y + s.halfLength;
  patch.add(core, 1);
}

// Within 60 degrees of the axis.
bool facesWithCap(const Vec3& d) { return std::abs(d.y()) > 0.5; }

Patch::Corner cut(const Patch::Corner& from, const Patch::Corner& to, double fromOut, double toOut,
                  std::uint32_t side) {
  const double part = fromOut / (fromOut - toOut);
  return {from.p + part * (to.p - from.p), cutId(from.edge, side), from.edge};
}

// Keeps what is inside of one plane: Sutherland and Hodgman. `out` is the distance outside.
template <typename Out>
void cutPolygon(Patch& patch, const Out& out, std::uint32_t side) {
  std::array<Patch::Corner, Patch::kRoom> kept;
  int count = 0;
  double here = out(patch.corners[0].p);
  for (int i = 0; i < patch.count; ++i) {
    const Patch::Corner& corner = patch.corners[i];
    const Patch::Corner& next = patch.corners[i + 1 < patch.count ? i + 1 : 0];
    const double there = out(next.p);
    if (here <= 0) kept[count++] = corner;
    if ((here <= 0) != (there <= 0)) {
      kept[count] = cut(corner, next, here, there, side);
      if (here <= 0) kept[count].edge = sideId(side);
      ++count;
    }
    here = there;
  }
  std::copy_n(kept.begin(), count, patch.corners.begin());
  patch.count = count;
}

template <typename Out>
void cutSegment(Patch& patch, const Out& out, std::uint32_t side) {
  const double first = out(patch.corners[0].p), last = out(patch.corners[1].p);
  if (first > 0 && last > 0) {
    patch.count = 0;
  } else if (first > 0) {
    patch.corners[0] = cut(patch.corners[0], patch.corners[1], first, last, side);
  } else if (last > 0) {
    patch.corners[1] = cut(patch.corners[0], patch.corners[1], first, last, side);
    patch.corners[1].id = otherCut(patch.corners[1].id);
  }
}

}  // namespace

int nearestFace(const Solid& s, const Vec3& d) {
  constexpr double kEqual = 1e-9;  // of cosines: the first of faces that differ by rounding alone
  int best = 0;
  if (s.kind == SolidKind::box) {
    for (int axis = 1; axis < 3; ++axis) {
      if (std::abs(d[axis]) > std::abs(d[best]) + kEqual) best = axis;
    }
    return 2 * best + (d[best] > 0 ? 1 : 0);
  }
  const auto& faces = s.hull->faces;
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].normal.dot(d) > faces[best].normal.dot(d) + kEqual) best = static_cast<int>(i);
  }
  return best;
}

void facing(const Solid& s, const Vec3& d, Patch& patch) {
  if (s.isPolyhedron()) return facetPatch(s, nearestFace(s, d), patch);
  if (s.kind == SolidKind::cylinder) {
    return facesWithCap(d) ? capPatch(s, d.y() > 0, d, patch) : sidePatch(s, d, patch);
  }
  patch.count = 0;
  patch.radius = s.rounding;
  patch.add(Vec3(0, -s.halfLength, 0), 0);
  if (s.halfLength > 0) patch.add(Vec3(0, s.halfLength, 0), 1);
}

int facetCount(const Solid& s) {
  if (s.isPolyhedron()) return static_cast<int>(s.hull->faces.size());
  return s.kind == SolidKind::cylinder ? 2 : 0;
}

Facet facet(const Solid& s, int index) {
  if (s.kind == SolidKind::box) {
    Vec3 normal = Vec3::Zero();
    normal[index / 2] = index % 2 ? 1 : -1;
    return {normal, s.half[index / 2]};
  }
  if (s.kind == SolidKind::cylinder) return {Vec3(0, index == 1 ? 1 : -1, 0), s.halfLength};
  const Hull::Face& face = s.hull->faces[index];
  return {face.normal, face.offset};
}

void facetPatch(const Solid& s, int index, Patch& patch) {
  if (s.kind == SolidKind::cylinder) return capPatch(s, index == 1, Vec3::Zero(), patch);
  patch.count = 0;
  patch.radius = 0;
  if (s.kind == SolidKind::box) {  // as below, out of the hull's way
    for (const int id : kBoxFaces[index]) {
      patch.add(cornerOf(s, id), static_cast<std::uint32_t>(id));
    }
    return;
  }
  const std::vector<int>& ids = s.hull->faces[index].vertices;
  const int corners = static_cast<int>(ids.size()), kept = std::min(corners, Patch::kMax);
  for (int k = 0; k < kept; ++k) {
    const int id = ids[kept == corners ? k : static_cast<std::int64_t>(k) * corners / kept];
    patch.add(s.hull->vertices[id], static_cast<std::uint32_t>(id & 0xffff));
  }
}

void transform(Patch& patch, const Relative& pose) {
  for (int i = 0; i < patch.count; ++i) patch.corners[i].p = pose.R * patch.corners[i].p + pose.t;
}

void clip(Patch& patch, const Patch& reference, const Vec3& normal, double tolerance) {
  for (int i = 0; i < reference.count && patch.count > 0; ++i) {
    const Vec3& from = reference.corners[i].p;
    const Vec3& to = reference.corners[i + 1 < reference.count ? i + 1 : 0].p;
    const Vec3 side = (to - from).cross(normal);
    const double limit = side.dot(from) + tolerance * (to - from).norm();
    const auto out = [&](const Vec3& p) { return side.dot(p) - limit; };
    const auto index = static_cast<std::uint32_t>(i);
    if (patch.count > 2) {
      cutPolygon(patch, out, index);
    } else if (patch.count == 2) {
      cutSegment(patch, out, index);
    } else if (out(patch.corners[0].p) > 0) {
      patch.count = 0;
    }
  }
}

}  // namespace physics::collision
