// The fifteen separating directions of two boxes.
#include <cmath>

#include "physics/collision/axis.h"

namespace physics::collision {
namespace {

constexpr double kParallel = 1e-8;  // sine squared

// Index of the edge along `axis` through the corner furthest along d (body frame).
int edgeTowards(const Solid& box, int axis, const Vec3& d) {
  int from = (d.x() > 0 ? 1 : 0) | (d.y() > 0 ? 2 : 0) | (d.z() > 0 ? 4 : 0);
  from &= ~(1 << axis);
  int index = 0;
  while (box.edges[index].from != from || box.edges[index].to != (from | 1 << axis)) ++index;
  return index;
}

Axis bestEdges(const Solid& a, const Solid& b, const Relative& pose) {
  Axis best;
  int bestA = 0, bestB = 0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      Vec3 n = pose.R.col(j).cross(Vec3::Unit(i));
      const double square = n.squaredNorm();
      if (square < kParallel) continue;
      n /= std::sqrt(square);
      const double separation = std::abs(n.dot(pose.t)) - b.half.dot(n.cwiseAbs()) -
                                a.half.dot((pose.R.transpose() * n).cwiseAbs());
      if (separation <= best.separation) continue;
      best.separation = separation;
      best.n = n.dot(pose.t) < 0 ? Vec3(-n) : n;
      bestA = j;
      bestB = i;
    }
  }
  if (best.separation == Axis().separation) return best;
  best.from = Axis::From::lines;
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
  axes.lines = bestEdges(a, b, pose);
  return axes;
}

}  // namespace physics::collision
