// A constraint is its error c(X), its gradient and its bounds; the solver is one.
// What is solved, and how, is constraint_solve.h.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "physics/base/fields.h"
#include "physics/base/rotation.h"
#include "physics/bodies/body.h"

namespace physics {

// What a constraint may look at: the present displaced poses X^{t+1} + dX, the poses at the start
// of the substep, and its length [s]. By bdf2 the start is where backward Euler would have started,
// dt two thirds of the substep, and `origin` and `before` are X^t and X^{t-1}. By the symmetric
// scheme a force is looked at in the middle of the substep, dt is half of it and `end` is X^{t+1}.
struct Configuration {
  std::span<const Pose> now, start;
  double dt = 0;
  std::span<const Pose> origin{}, before{}, end{};
};

// What c, a function of the poses, has changed by since the start; over dt it is the rate of c. Of
// a curved c the second-order steppings may not take c(now) - c(start): that rate is off by O(dt).
template <class F>
auto changeSinceStart(const Configuration& x, F&& c) {
  using Value = decltype(c(x.now));
  if (!x.end.empty()) return Value((c(x.end) - c(x.start)) / 2);
  if (!x.before.empty()) return Value(c(x.now) - (4 * c(x.origin) - c(x.before)) / 3);
  return Value(c(x.now) - c(x.start));
}

// The number of bodies of a kind whose constraints have each their own: the nodes of a rope.
constexpr int kMany = -1;

template <int kBodies, class T>
using PerBody = std::conditional_t<kBodies == kMany, std::vector<T>,
                                   std::array<T, static_cast<std::size_t>(std::max(kBodies, 0))>>;

// What a constraint and a force have in common at a configuration.
template <int kBodies, int kRows>
struct Gradients {
  using Vector = Eigen::Matrix<double, kRows, 1>;
  using Matrix = Eigen::Matrix<double, kRows, kRows>;
  using Gradient = Eigen::Matrix<double, kRows, 3>;
  Vector c = Vector::Zero();           // the coordinates: a constraint's error, a spring's stretch
  PerBody<kBodies, Gradient> linear;   // dc/dx, only where the kind is linear
  PerBody<kBodies, Gradient> angular;  // dc/dtheta, only where it is angular; theta is a
                                       // world-frame rotation, q <- exp(theta) q
  bool active = true;                  // false: nothing to solve, whatever c
  double longest = std::numeric_limits<double>::infinity();  // bound of the total's length
};

template <class C>
using VectorOf = Eigen::Matrix<double, C::kRows, 1>;
template <class C>
using MatrixOf = Eigen::Matrix<double, C::kRows, C::kRows>;

// Error, gradient and bounds of one constraint: c = 0, or one-sided where the total is bounded.
template <int kBodies, int kRows>
struct Row : Gradients<kBodies, kRows> {
  double alpha = 0;                                       // compliance over h^2, in units of A
  double low = -std::numeric_limits<double>::infinity();  // bounds of every component of the total
  double high = std::numeric_limits<double>::infinity();
};

// A force along J: its value at the present displacement and how it falls off with c, (102)-(105).
template <int kBodies, int kRows>
struct Push : Gradients<kBodies, kRows> {
  typename Gradients<kBodies, kRows>::Vector f;  // times h^2
  typename Gradients<kBodies, kRows>::Matrix k;  // K = -df/dc times h^2, not negative definite
};

template <class C>
concept EvaluatesPush = requires(const C& item, Push<C::kBodies, C::kRows>& push) {
  item.evaluate(Configuration{}, push);
};

// Forces have no error that could stand, and no row in the direct method. A frozen row says so.
template <class C>
concept Force = EvaluatesPush<C> || C::kIsForce;

template <class C>
using Evaluated =
    std::conditional_t<Force<C>, Push<C::kBodies, C::kRows>, Row<C::kBodies, C::kRows>>;

// Points have no rotation, and a kind over points does not pay for one.
template <class C>
constexpr bool isAngular() {
  if constexpr (requires { C::kAngular; }) return C::kAngular;
  return true;
}

// Whether it has J along x, along theta; of a frozen row it says so itself.
template <class C>
bool hasLinear(const C& item) {
  if constexpr (requires { C::kLinear; }) {
    return C::kLinear;
  } else {
    return item.isLinear;
  }
}
template <class C>
bool hasAngular(const C& item) {
  if constexpr (requires { C::kLinear; }) {
    return isAngular<C>();
  } else {
    return item.isAngular;
  }
}

// These go by the numbers of bodies and rows alone, so that kinds of one shape share them.
template <int kBodies, int kRows>
struct ResponseOf {  // M^-1 J^T, per body
  PerBody<kBodies, Eigen::Matrix<double, 3, kRows>> linear, angular;
};
template <class C>
using Response = ResponseOf<C::kBodies, C::kRows>;

template <class C>
Form formOf(const C& item) {
  if constexpr (requires { item.form; }) return item.form;
  return Form::kVector;
}

// A constraint or force without its kind: all that its solve asks of it once it is evaluated.
template <int kBodyCount, int kRowCount>
struct RowShape {
  static constexpr int kBodies = kBodyCount, kRows = kRowCount;
  std::span<const BodyId,
            kBodies == kMany ? std::dynamic_extent : static_cast<std::size_t>(std::max(kBodies, 0))>
      bodies;
  bool isLinear, isAngular;
  Form form;
};
template <class C>
RowShape<C::kBodies, C::kRows> shapeOf(const C& item) {
  return {item.bodies, hasLinear(item), hasAngular(item), formOf(item)};
}

// What a visit works in. Kept by the set where its size differs from one constraint to the next.
template <class RowOrPush, class ResponseToIt>
struct RowAndResponse {
  RowOrPush row;
  ResponseToIt response;
};
template <class C>
using Scratch = RowAndResponse<Evaluated<C>, Response<C>>;

template <int kRows>
struct Totals {
  using Vector = Eigen::Matrix<double, kRows, 1>;
  Vector total = Vector::Zero();  // accumulated
  bool loaded = false;            // it had a multiplier in the last substep
  double step = 0;                // the dt that `total` belongs to [s]
};
template <class C>
using Multipliers = Totals<C::kRows>;

// How its solve is tuned: xi of (53), epsilon of (56).
struct Tuned {
  double relaxation, regularisation;
  bool damps = false;  // the regularisation is in mu alone
};

// The constraints of one kind, in the order they were added.
template <class C>
struct Set {
  std::vector<C> items;
  std::vector<int> active;    // items that are solved: all, but for those of bodies that sleep
  std::vector<int> overTime;  // items that follow a table
  std::vector<Multipliers<C>> lambda;
  std::vector<Multipliers<C>> kept;  // of the start of a step that may be made anew
  std::vector<Tuned> tuned;
  Scratch<C> scratch;  // of kinds with kMany bodies
};

// Constraints on velocities, such as motors, have no error that could stand at X^t either.
template <class C>
constexpr bool canStand() {
  return !Force<C> && !requires { C::kOfVelocity; };
}

// Equalities without bounds: the rows that the direct method takes.
template <class C>
bool isEquality(const C& item) {
  if constexpr (requires { item.isEquality(); }) return item.isEquality();
  return false;
}

// Rows of the direct method: equalities, and bounds on one side while they hold.
template <class C>
bool isSolvedDirectly(const C& item) {
  if constexpr (Force<C> || C::kBodies != 2) return false;
  if constexpr (requires { item.isOneSided(); }) return isEquality(item) || item.isOneSided();
  return isEquality(item);
}

}  // namespace physics
