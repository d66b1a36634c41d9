// A constraint or force of a deformable, of any number of bodies, as it was evaluated last. Of its
// kind only the evaluation knows; all else goes by the number of its rows.
#pragma once

#include <Eigen/LU>
#include <array>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include "physics/base/profile.h"
#include "physics/solver/articulation.h"
#include "physics/solver/joint_row.h"

namespace physics {

// What rows of any number have.
struct SweptItem {
  JointRef ref{};
  bool isForce = false, isLink = false, isLength = false;
  bool stands = true;               // what it wants is a place, not a speed
  bool isPair = false;              // it holds two bodies, by where they are
  bool isBothWays = false;          // without a bound, elastic ones as well
  bool moves = true, turns = true;  // it has J along x, along theta
  bool isAtOnce = false;            // solved with the others that hold points, not swept
  bool isImplied = false;           // others hold it

  // As it was evaluated last.
  bool active = false;
  bool swept = false;   // it has anything to say, and can move something
  bool isLoad = false;  // a force that does not fall off
  bool held = false;    // at a bound, while the others are solved for
  double low = -std::numeric_limits<double>::infinity();  // bounds of the total
  double high = std::numeric_limits<double>::infinity();
  double longest = std::numeric_limits<double>::infinity();
  double own = 0;             // mean of A's diagonal
  double length = 0;          // of a link, of all pieces of a rope [m]
  double regularisation = 0;  // relative to A

  std::vector<BodyId> bodies;
  std::array<int, 2> place = {-1, -1};  // at once: of its bodies, -1: it does not move
  bool isOfPieces() const { return isLink || isLength; }
};

template <int kRows>
struct SweptRow : SweptItem {
  using Vector = Eigen::Matrix<double, kRows, 1>;
  using Matrix = Eigen::Matrix<double, kRows, kRows>;
  struct Part {
    Eigen::Matrix<double, kRows, 3> j;
    Eigen::Matrix<double, 3, kRows> response;  // M^-1 J^T
  };
  std::vector<Part> linear, angular;  // by body; none where it does not move or turn
  Vector c = Vector::Zero();
  Matrix inverse = Matrix::Zero(), alpha = Matrix::Zero();    // (A + alpha)^-1
  Vector constant = Vector::Zero(), lambda = Vector::Zero();  // c - J u_0
  Vector kept = Vector::Zero();                               // lambda, to go back to
  Vector pulled = Vector::Zero(), next = Vector::Zero();      // lambda of the last substep or step
                                                              // of Newton's; and of its next one
};

// Those of a deformable, in the order of the table of kinds.
struct SweptRows {
  struct Run {  // of one kind
    int kind;
    const char* word;
    int rows, begin, end;
  };
  std::vector<Run> runs;
  std::tuple<std::vector<SweptRow<1>>, std::vector<SweptRow<2>>, std::vector<SweptRow<3>>> lists;
};

namespace swept {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// Of these, in the table's order.
SweptRows rowsOf(std::span<const JointRef> refs, const Kinds& kinds);

enum class Seen { kGradients, kAll };  // J and c alone; or alpha, constant and bounds as well
// `many`: to work in.
template <int kRows>
void evaluate(const Kinds& kinds, const Configuration& at, Seen seen, Row<kMany, 1>& many,
              SweptRow<kRows>& swept);

template <int kRows>
typename SweptRow<kRows>::Vector along(const SweptRow<kRows>& swept,
                                       std::span<const Displacement> moved) {
  typename SweptRow<kRows>::Vector sum = SweptRow<kRows>::Vector::Zero();
  for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
    const Displacement& m = moved[swept.bodies[b]];
    if (swept.moves) sum.noalias() += swept.linear[b].j.lazyProduct(m.u);
    if (swept.turns) sum.noalias() += swept.angular[b].j.lazyProduct(m.theta);
  }
  return sum;
}

template <int kRows>
void give(const SweptRow<kRows>& swept, const typename SweptRow<kRows>::Vector& impulse,
          std::span<Displacement> moved) {
  for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
    Displacement& m = moved[swept.bodies[b]];
    if (swept.moves) m.u.noalias() += swept.linear[b].response.lazyProduct(impulse);
    if (swept.turns) m.theta.noalias() += swept.angular[b].response.lazyProduct(impulse);
  }
}

// A, with M^-1 J^T on the way.
template <int kRows>
typename SweptRow<kRows>::Matrix respond(SweptRow<kRows>& swept,
                                         std::span<const JointMass> masses) {
  typename SweptRow<kRows>::Matrix a = SweptRow<kRows>::Matrix::Zero();
  for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
    const auto& [inverse, inertia] = masses[swept.bodies[b]];
    if (swept.moves) {
      auto& [j, response] = swept.linear[b];
      response = inverse * j.transpose();
      a.noalias() += j.lazyProduct(response);
    }
    if (swept.turns) {
      auto& [j, response] = swept.angular[b];
      response.noalias() = inertia.lazyProduct(j.transpose());
      a.noalias() += j.lazyProduct(response);
    }
  }
  return a;
}

template <int kRows>
typename SweptRow<kRows>::Vector clamped(const SweptRow<kRows>& swept,
                                         const typename SweptRow<kRows>::Vector& total) {
  typename SweptRow<kRows>::Vector inside = total.cwiseMax(swept.low).cwiseMin(swept.high);
  const double length = inside.norm();
  if (length > swept.longest) inside *= swept.longest / length;  // (132)
  return inside;
}

template <int kRows>
void invert(SweptRow<kRows>& swept, typename SweptRow<kRows>::Matrix a, double regularisation) {
  const double mean = a.trace() / kRows;
  swept.swept = mean > 1e-300;  // else it moves nothing
  swept.held = false;
  swept.own = mean;
  if (!swept.swept) return;
  swept.alpha.diagonal().array() += regularisation * mean;
  a += swept.alpha;
  a.diagonal().array() += 1e-12 * mean;  // 1e4 roundings: regular where its rows repeat
  swept.inverse = a.inverse();
}

template <int kRows>
void change(SweptRow<kRows>& swept, const typename SweptRow<kRows>::Vector& error,
            std::span<Displacement> moved) {
  using Vector = typename SweptRow<kRows>::Vector;
  const Vector total = clamped<kRows>(swept, swept.lambda - swept.inverse * error);
  give<kRows>(swept, total - swept.lambda, moved);
  swept.lambda = total;
}

// Velocities are not its to hold; a motor's speed is not zero.
template <int kRows>
bool givesWay(const SweptRow<kRows>& swept) {
  return swept.isForce || !swept.stands || !swept.alpha.isZero(0);
}

inline bool isBounded(const SweptItem& swept) {
  return swept.low > -kUnbounded || swept.high < kUnbounded || swept.longest < kUnbounded;
}

// It has a bound, and did not have to hold anything.
template <int kRows>
bool isSlack(const SweptRow<kRows>& swept) {
  return isBounded(swept) && swept.lambda.isZero(0);
}

// f(row) of each.
template <class Rows, class F>
void forEachRow(Rows& rows, F&& f) {
  const auto walk = [&](auto& list, const SweptRows::Run& run) {
    for (int k = run.begin; k < run.end; ++k) f(list[k]);
  };
  for (const SweptRows::Run& run : rows.runs) {
    profileScope(run.word);
    if (run.rows == 1) walk(std::get<0>(rows.lists), run);
    if (run.rows == 2) walk(std::get<1>(rows.lists), run);
    if (run.rows == 3) walk(std::get<2>(rows.lists), run);
  }
}

}  // namespace swept
}  // namespace physics
