// The fifteen separating directions of two boxes.
#include <cmath>

#include "physics/collision/axis.h"

namespace physics::collision {
namespace {

constexpr double kParallelEdges = 1e-8;  // sine squared

// Index of the edge along `axis` through the corner furthest along d (body frame).
int edgeTowards(const Solid& box, int axis, const Vec3& d) {
  int from = (d.x() > 0 ? 1 : 0) | (d.y() > 0 ? 2 : 0) | (d.z() > 0 ? 4 : 0);
  from &= ~(1 << axis);
  int index = 0;
  while (box.edges[index].from != from || box.edges[index].to != (from | 1 << axis)) ++index;
  return index;
}

// L = (axis j of a) x (axis i of b), of length sqrt(1 - R_ij^2). In terms of R alone,
//   t . L = t_i1 R_i2,j - t_i2 R_i1,j,  and the boxes reach |L| far by sums of four entries of |R|.
Axis bestEdges(const Solid& a, const Solid& b, const Relative& pose, const Mat3& size) {
  Axis best;
  int bestA = -1, bestB = 0;
  for (int j = 0; j < 3; ++j) {
    const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    for (int i = 0; i < 3; ++i) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      const double square = 1 - size(i, j) * size(i, j);
      if (square < kParallelEdges) continue;
      const double along = pose.t[i1] * pose.R(i2, j) - pose.t[i2] * pose.R(i1, j);
      const double reachB = b.half[i1] * size(i2, j) + b.half[i2] * size(i1, j);
      const double reachA = a.half[j1] * size(i, j2) + a.half[j2] * size(i, j1);
      const double separation = (std::abs(along) - reachB - reachA) / std::sqrt(square);
      if (separation <= best.separation) continue;
      best.separation = separation;
      bestA = j;
      bestB = i;
    }
  }
  if (bestA < 0) return best;
  best.from = Axis::From::lines;
  best.n = pose.R.col(bestA).cross(Vec3::Unit(bestB)).normalized();
  if (best.n.dot(pose.t) < 0) best.n = -best.n;
  best.indexA = edgeTowards(a, bestA, -(pose.R.transpose() * best.n));
  best.indexB = edgeTowards(b, bestB, best.n);
  return best;
}

}  // namespace

Axes findBoxAxes(const Solid& a, const Solid& b, const Relative& pose, double enough) {
  Axes axes;
  const Mat3 size = pose.R.cwiseAbs();
  int i = 0;
  axes.facetB.from = Axis::From::facetB;
  axes.facetB.separation = (pose.t.cwiseAbs() - b.half - size * a.half).maxCoeff(&i);
  axes.facetB.indexB = 2 * i + (pose.t[i] > 0 ? 1 : 0);
  axes.facetB.n = pose.t[i] > 0 ? Vec3(Vec3::Unit(i)) : Vec3(-Vec3::Unit(i));
  if (axes.facetB.separation > enough) return axes;
  const Vec3 seen = pose.R.transpose() * pose.t;
  axes.facetA.from = Axis::From::facetA;
  axes.facetA.separation = (seen.cwiseAbs() - a.half - size.transpose() * b.half).maxCoeff(&i);
  axes.facetA.indexA = 2 * i + (seen[i] > 0 ? 0 : 1);
  axes.facetA.n = seen[i] > 0 ? Vec3(pose.R.col(i)) : Vec3(-pose.R.col(i));
  if (axes.facetA.separation > enough) return axes;
  axes.lines = bestEdges(a, b, pose, size);
  return axes;
}

}  // namespace physics::collision
