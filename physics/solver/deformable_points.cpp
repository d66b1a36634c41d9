// What holds the points of a cloth: all of its links at once, and the rest of it swept.
#include <algorithm>
#include <map>

#include "physics/base/inverse.h"
#include "physics/solver/deformable.h"

namespace physics {

using namespace swept;

namespace {

// Rows that see of two bodies where they are to each other, and no turn.
template <class C>
concept Pair = !Force<C> && C::kBodies == 2 && C::kLinear;

// Rows without a bound, elastic ones as well.
template <class C>
bool holdsBothWays(const C& item) {
  if constexpr (std::is_same_v<C, Link>) return !item.rope;
  return isEquality(item);
}

// f(row, column, sign) of what a row adds to the matrix: on its two places and between them.
template <class F>
void forEachBlock(const std::array<int, 2>& place, F&& f) {
  const auto [less, more] = std::minmax(place[0], place[1]);
  for (const int at : place) {
    if (at >= 0) f(at, at, 1);
  }
  if (less >= 0) f(more, less, -1);
}

// What a row gives way by, inverse.
template <class C>
typename SweptRow<C>::Matrix stiffnessOf(const SweptRow<C>& swept) {
  typename SweptRow<C>::Matrix gives = swept.alpha;
  gives.diagonal().array() += kRedundancy * swept.own;
  return inverseOrNan(gives);
}

}  // namespace

Mat3 turningStiffness(const Vec3& d, double pull, double length) {
  if (!(pull > 0) || !(length > 0)) return Mat3::Zero();
  return pull / length * (Mat3::Identity() - d * d.transpose());
}

// Which rows are solved at once: those that hold points, unless their factor would fill up.
void Deformable::layOutPoints(const Kinds& kinds, std::span<const InverseMass> masses) {
  std::vector<std::array<int, 2>> entries;
  for (int k = 0; k < static_cast<int>(bodies_.size()); ++k) entries.push_back({k, k});
  bool any = false;  // between two that move
  const auto isPoint = [&](BodyId i) { return !(masses[i].m > 0) || masses[i].inertia.isZero(0); };
  forEachRow(rows_, kinds, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if constexpr (Pair<C>) {
      const auto [a, b] = item.bodies;
      swept.isAtOnce = holdsBothWays(item) && isPoint(a) && isPoint(b);
      if (!swept.isAtOnce) return;
      swept.place = {placeOf(a), placeOf(b)};
      forEachBlock(swept.place, [&](int row, int column, double) {
        entries.push_back({row, column});
        any = any || row != column;
      });
    }
  });
  if (any) {
    points_ = std::make_unique<PointFactor>();
    points_->factor.layOut(entries);
    if (points_->factor.fill() <= kMostFill) return findImplied(kinds);
    points_.reset();
  }
  forEachRow(rows_, kinds,
             [&]<class C>(const C&, SweptRow<C>& swept, double) { swept.isAtOnce = false; });
}

// A total length that the links along it add up to, within what they give way by, is held by them.
void Deformable::findImplied(const Kinds& kinds) {
  std::map<std::array<int, 2>, double> lengths;
  const auto keyOf = [&](BodyId a, BodyId b) {
    return std::array<int, 2>{std::min(a, b), std::max(a, b)};
  };
  forEachRow(rows_, kinds, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if constexpr (std::is_same_v<C, Link>) {
      if (swept.isAtOnce && isEquality(item))
        lengths[keyOf(item.bodies[0], item.bodies[1])] = item.length;
    }
  });
  forEachRow(rows_, kinds, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if constexpr (std::is_same_v<C, RopeLength>) {
      double sum = 0;
      for (std::size_t p = 1; p < item.bodies.size(); ++p) {
        const auto found = lengths.find(keyOf(item.bodies[p - 1], item.bodies[p]));
        if (found == lengths.end()) return;
        sum += found->second;
      }
      swept.isAtOnce = sum <= (1 + kRedundancy) * item.length;
    }
  });
}

// M + J^T alpha^-1 J and, of positions, K.
void Deformable::factorizePoints(bool positions, std::span<const JointMass> masses) {
  PointFactor& f = *points_;
  f.rows.clear();
  f.inverse.clear();
  f.factor.begin();
  for (const BodyId i : bodies_) {
    f.inverse.push_back(masses[i].inverse);
    f.factor.give(Mat3::Identity() / masses[i].inverse);
  }
  forEachRow(rows_, *kinds_, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if constexpr (Pair<C>) {
      if (!swept.isAtOnce) return;
      Mat3 block = Mat3::Zero();
      if (swept.swept) {
        const auto& j = swept.row.linear[0];
        block.noalias() = j.transpose() * stiffnessOf<C>(swept) * j;
        if constexpr (std::is_same_v<C, Link>) {
          const double length = item.length + swept.row.c[0];
          const double pull = positions ? -swept.pulled[0] : 0;
          block += turningStiffness(j.transpose(), pull, length);
        }
      }
      forEachBlock(swept.place, [&](int, int, double sign) { f.factor.give(sign * block); });
      f.rows.push_back(block);
    }
  });
  f.factor.factorize();
}

template <class C>
Vec3 Deformable::apartBy(const SweptRow<C>& swept) const {
  Vec3 apart = Vec3::Zero();
  const auto [a, b] = swept.place;
  if (a >= 0) apart += points_->change[a];
  if (b >= 0) apart -= points_->change[b];
  return apart;
}

double Deformable::turnByChange() {
  double most = 0;
  forEachRow(rows_, *kinds_, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if constexpr (std::is_same_v<C, Link>) {
      if (!swept.isAtOnce || !swept.swept) return;
      const Vec3 across = swept.row.linear[0].transpose().cross(apartBy(swept));
      const double length = item.length + swept.row.c[0];
      most = std::max(most, length > 0 ? across.norm() / length : kUnbounded);
    }
  });
  return most;
}

// Where d ends the rows are off by more than they were evaluated for.
bool Deformable::isBent() const {
  return points_ && !points_->isLost && points_->turn > kStraightTurn;
}

// (M + K) d - J^T lambda = 0, J d + alpha lambda = -c for the change d of u and, of positions, for
// lambda itself; its change, of velocities.
void Deformable::solvePoints(bool positions, std::span<Displacement> moved) {
  PointFactor& f = *points_;
  if (f.isLost) return;
  f.change.assign(bodies_.size(), Vec3::Zero());
  const auto errorNow = [&]<class C>(const C& item, const SweptRow<C>& swept) {
    typename Set<C>::Vector error = along(item, swept, moved);
    if (positions) {
      error += swept.constant + swept.alpha * swept.lambda + kRedundancy * swept.own * swept.lambda;
    }
    return error;
  };
  forEachRow(rows_, *kinds_, [&]<class C>(const C& item, SweptRow<C>& swept, double) {
    if constexpr (Pair<C>) {
      if (!swept.isAtOnce || !swept.swept) return;
      swept.next = stiffnessOf<C>(swept) * errorNow(item, swept);
      const Vec3 push = swept.row.linear[0].transpose() * swept.next;
      const auto [a, b] = swept.place;
      if (a >= 0) f.change[a] -= push;
      if (b >= 0) f.change[b] += push;
    }
  });
  f.factor.solve(f.change);
  f.turn = positions ? turnByChange() : 0;
  f.isLost = f.turn > kFarTurn;
  if (f.isLost) return;
  // By what each row gives to both of its ends: their momentum stays, to rounding.
  std::size_t at = 0;
  forEachRow(rows_, *kinds_, [&]<class C>(const C&, SweptRow<C>& swept, double) {
    if constexpr (Pair<C>) {
      if (!swept.isAtOnce) return;
      const Mat3& block = f.rows[at++];
      if (!swept.swept) return;
      const auto& j = swept.row.linear[0];
      const Vec3 apart = apartBy(swept), push = j.transpose() * swept.next + block * apart;
      const auto [a, b] = swept.place;
      if (a >= 0) moved[bodies_[a]].u -= f.inverse[a] * push;
      if (b >= 0) moved[bodies_[b]].u += f.inverse[b] * push;
      swept.lambda -= swept.next + stiffnessOf<C>(swept) * (j * apart);
    }
  });
}

}  // namespace physics
