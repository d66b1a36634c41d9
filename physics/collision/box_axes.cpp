// The fifteen separating directions of two boxes, and those of a capsule's segment and a box.
#include <algorithm>
#include <cmath>

#include "physics/collision/axis.h"

namespace physics::collision {
namespace {

constexpr double kParallelEdges = 1e-8;  // sine squared: a normal known to 1e-12
constexpr double kNone = -1e300;

// The edges of Hull boxes: by axis, then by the corner they start from without that axis' bit.
constexpr int kEdges[3][8] = {
    {0, -1, 5, -1, 8, -1, 11, -1}, {1, 3, -1, -1, 9, 10, -1, -1}, {2, 4, 6, 7, -1, -1, -1, -1}};

// Index of the edge along `axis` through the corner furthest along d (body frame).
int edgeTowards(int axis, const Vec3& d) {
  const int corner = (d.x() > 0 ? 1 : 0) | (d.y() > 0 ? 2 : 0) | (d.z() > 0 ? 4 : 0);
  return kEdges[axis][corner & ~(1 << axis)];
}

// The largest of what is offered; the first of equals.
struct Largest {
  double value = kNone;
  int index = 0;
  void offer(double v, int i) {
    index = v > value ? i : index;
    value = v > value ? v : value;
  }
};

// L = (axis j of a) x (axis i of b), of length sqrt(1 - R_ij^2). In terms of R alone,
//   t . L = t_i1 R_i2,j - t_i2 R_i1,j,  and the boxes reach |L| far by sums of four entries of |R|.
// Signed squares of the separations are compared: no root, and no quotient but for a better one.
template <int j>
void offerEdges(const Solid& a, const Solid& b, const Relative& pose, const Mat3& size,
                Largest& best) {
  constexpr int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    const double square = 1 - size(i, j) * size(i, j);
    const double along = pose.t[i1] * pose.R(i2, j) - pose.t[i2] * pose.R(i1, j);
    const double reachB = b.half[i1] * size(i2, j) + b.half[i2] * size(i1, j);
    const double reachA = a.half[j1] * size(i, j2) + a.half[j2] * size(i, j1);
    const double s = std::abs(along) - reachB - reachA;
    if (s * std::abs(s) > best.value * square && square >= kParallelEdges) {
      best = {s * std::abs(s) / square, 3 * j + i};
    }
  }
}

// Index -1: none is better than `most`, what the faces have.
Largest bestEdges(const Solid& a, const Solid& b, const Relative& pose, const Mat3& size,
                  double most) {
  Largest best{most * std::abs(most), -1};
  offerEdges<1>(a, b, pose, size, best);
  if (!a.isLine()) {  // a segment has edges along y only
    offerEdges<0>(a, b, pose, size, best);
    offerEdges<2>(a, b, pose, size, best);
  }
  best.value = std::copysign(std::sqrt(std::abs(best.value)), best.value);
  return best;
}

Axis edgeAxis(const Solid& a, const Relative& pose, const Largest& edges) {
  const int axisA = edges.index / 3, axisB = edges.index % 3;
  Axis axis{Axis::From::lines, pose.R.col(axisA).cross(Vec3::Unit(axisB)).normalized(), edges.value,
            0, 0};
  if (axis.n.dot(pose.t) < 0) axis.n = -axis.n;
  if (!a.isLine()) axis.indexA = edgeTowards(axisA, -(pose.R.transpose() * axis.n));
  axis.indexB = edgeTowards(axisB, axis.n);
  return axis;
}

}  // namespace

Axes findBoxAxes(const Solid& a, const Solid& b, const Relative& pose, double enough) {
  Axes axes;
  const Mat3 size = pose.R.cwiseAbs();
  const Vec3& t = pose.t;
  Largest face;
  for (int i = 0; i < 3; ++i) {
    const double reach = size(i, 0) * a.half[0] + size(i, 1) * a.half[1] + size(i, 2) * a.half[2];
    face.offer(std::abs(t[i]) - b.half[i] - reach, i);
  }
  int k = face.index;
  axes.facetB = {Axis::From::facetB, t[k] > 0 ? Vec3(Vec3::Unit(k)) : Vec3(-Vec3::Unit(k)),
                 face.value, -1, 2 * k + (t[k] > 0 ? 1 : 0)};
  if (face.value > enough) return axes;
  double most = face.value;
  if (!a.isLine()) {
    const Vec3 seen = pose.R.transpose() * t;
    face = {};
    for (int j = 0; j < 3; ++j) {
      const double reach = size(0, j) * b.half[0] + size(1, j) * b.half[1] + size(2, j) * b.half[2];
      face.offer(std::abs(seen[j]) - a.half[j] - reach, j);
    }
    k = face.index;
    axes.facetA = {Axis::From::facetA, seen[k] > 0 ? Vec3(pose.R.col(k)) : Vec3(-pose.R.col(k)),
                   face.value, 2 * k + (seen[k] > 0 ? 0 : 1), -1};
    if (face.value > enough) return axes;
    most = std::max(most, face.value);
  }
  const Largest edges = bestEdges(a, b, pose, size, most);
  if (edges.index >= 0) axes.lines = edgeAxis(a, pose, edges);
  return axes;
}

}  // namespace physics::collision
