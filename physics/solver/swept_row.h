// A constraint or force of a deformable, of any number of bodies, and what it takes part in.
#pragma once

#include <Eigen/LU>
#include <limits>
#include <span>
#include <vector>

#include "physics/base/profile.h"
#include "physics/constraints/constraint_response.h"
#include "physics/constraints/kinds.h"
#include "physics/solver/articulation.h"

namespace physics {

// One constraint or force, as it was evaluated last.
template <class C>
struct SweptRow {
  using Vector = typename Set<C>::Vector;
  using Matrix = Eigen::Matrix<double, C::kRows, C::kRows>;
  int item = 0;
  bool swept = false;                   // it has anything to say, and can move something
  bool isLoad = false;                  // a force that does not fall off
  double own = 0;                       // mean of A's diagonal
  bool held = false;                    // at a bound, while the others are solved for
  bool isAtOnce = false;                // solved with the others that hold points, not swept
  bool isImplied = false;               // others hold it
  std::array<int, 2> place = {-1, -1};  // then: of its bodies, -1: it does not move
  Evaluated<C> row;
  Response<C> response;                                       // M^-1 J^T
  Matrix inverse = Matrix::Zero(), alpha = Matrix::Zero();    // (A + alpha)^-1
  Vector constant = Vector::Zero(), lambda = Vector::Zero();  // c - J u_0
  Vector pulled = Vector::Zero(), next = Vector::Zero();      // lambda of the last substep or step
                                                              // of Newton's; and of its next one
  double low = 0, high = 0;
};

template <class Table>
struct SweptRowsOf;
template <class... K>
struct SweptRowsOf<std::tuple<K...>> {
  using Type = std::tuple<std::vector<SweptRow<typename K::Item>>...>;
};
using SweptRows = SweptRowsOf<Kinds>::Type;

namespace swept {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
// Of a push that falls off in some directions only: how stiff it is taken to be in the others,
// relative to its mean.
inline constexpr double kLeastStiffness = 1e-7;
template <class C>
typename Set<C>::Vector along(const C& item, const SweptRow<C>& swept,
                              std::span<const Displacement> moved) {
  typename Set<C>::Vector sum = Set<C>::Vector::Zero();
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const Displacement& m = moved[item.bodies[b]];
    if constexpr (C::kLinear) sum.noalias() += swept.row.linear[b].lazyProduct(m.u);
    if constexpr (isAngular<C>()) sum.noalias() += swept.row.angular[b].lazyProduct(m.theta);
  }
  return sum;
}

template <class C>
void give(const C& item, const SweptRow<C>& swept, const typename Set<C>::Vector& impulse,
          std::span<Displacement> moved) {
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    Displacement& m = moved[item.bodies[b]];
    if constexpr (C::kLinear) m.u.noalias() += swept.response.linear[b].lazyProduct(impulse);
    if constexpr (isAngular<C>()) {
      m.theta.noalias() += swept.response.angular[b].lazyProduct(impulse);
    }
  }
}

// A, with M^-1 J^T on the way.
template <class C>
typename SweptRow<C>::Matrix respond(const C& item, SweptRow<C>& swept,
                                     std::span<const JointMass> masses) {
  const auto massOf = [&](BodyId body) -> const JointMass& { return masses[body]; };
  return physics::respond(item, swept.row, swept.response, massOf);
}

// alpha and c of what was evaluated.
template <class C>
typename Set<C>::Vector errorOf(SweptRow<C>& swept) {
  if constexpr (Force<C>) {
    swept.low = -kUnbounded;
    swept.high = kUnbounded;
    const double mean = swept.row.k.trace() / C::kRows;
    swept.isLoad = !(mean > 0);
    if (swept.isLoad) return swept.row.f;
    typename SweptRow<C>::Matrix k = 0.5 * (swept.row.k + swept.row.k.transpose());
    k.diagonal().array() += kLeastStiffness * mean;
    swept.alpha = k.inverse();
    return -(swept.alpha * swept.row.f);
  } else {
    swept.low = swept.row.low;
    swept.high = swept.row.high;
    swept.alpha = swept.row.alpha * SweptRow<C>::Matrix::Identity();
    return swept.row.c;
  }
}

template <class C>
typename Set<C>::Vector clamped(const SweptRow<C>& swept, const typename Set<C>::Vector& total) {
  typename Set<C>::Vector inside = total.cwiseMax(swept.low).cwiseMin(swept.high);
  const double length = inside.norm();
  if (length > swept.row.longest) inside *= swept.row.longest / length;  // (132)
  return inside;
}

template <class C>
void invert(SweptRow<C>& swept, typename SweptRow<C>::Matrix a, double regularisation) {
  const double mean = a.trace() / C::kRows;
  swept.swept = mean > 1e-300;  // else it moves nothing
  swept.held = false;
  swept.own = mean;
  if (!swept.swept) return;
  swept.alpha.diagonal().array() += regularisation * mean;
  a += swept.alpha;
  a.diagonal().array() += 1e-12 * mean;  // 1e4 roundings: regular where its rows repeat
  swept.inverse = a.inverse();
}

template <class C>
void change(const C& item, SweptRow<C>& swept, const typename Set<C>::Vector& error,
            std::span<Displacement> moved) {
  const typename Set<C>::Vector total = clamped<C>(swept, swept.lambda - swept.inverse * error);
  give(item, swept, typename Set<C>::Vector(total - swept.lambda), moved);
  swept.lambda = total;
}

// Velocities are not its to hold; a motor's speed is not zero.
template <class C>
bool givesWay(const SweptRow<C>& swept) {
  return Force<C> || !canStand<C>() || !swept.alpha.isZero(0);
}

template <class C>
bool isBounded(const SweptRow<C>& swept) {
  return swept.low > -kUnbounded || swept.high < kUnbounded || swept.row.longest < kUnbounded;
}

// It has a bound, and did not have to hold anything.
template <class C>
bool isSlack(const SweptRow<C>& swept) {
  return isBounded(swept) && swept.lambda.isZero(0);
}

// f(item, swept, regularisation) of every row.
template <class F>
void forEachRow(SweptRows& rows, const Kinds& kinds, F&& f) {
  forEachKind(kinds, [&](const auto& kind) {
    using K = std::decay_t<decltype(kind)>;
    using C = typename K::Item;
    auto& list = std::get<std::vector<SweptRow<C>>>(rows);
    if (!list.empty()) profileScope(K::kWord);
    for (SweptRow<C>& swept : list) {
      f(kind.set.items[swept.item], swept, kind.set.tuned[swept.item].regularisation);
    }
  });
}

}  // namespace swept
}  // namespace physics
