// Ropes and what else has a factor with little fill: all rows at once.
#include <algorithm>

#include "physics/solver/deformable.h"

namespace physics {

using namespace swept;

namespace {

// What a row that may be held is off by, at what the bodies have moved by.
template <int kRows>
typename SweptRow<kRows>::Vector rowError(const SweptRow<kRows>& swept, bool positions,
                                          std::span<const Displacement> moved) {
  const typename SweptRow<kRows>::Vector rate = along(swept, moved);
  return positions ? swept.constant + rate + swept.alpha * swept.lambda : rate;
}

}  // namespace

// Rows that the solution would take past a bound are held there, and the others are to be solved
// for again.
bool Deformable::holdAtBounds(std::span<Displacement> moved) {
  bool any = false;
  int at = unknowns_;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    const int first = at;
    at += kRows;
    if (!swept.swept || swept.held || !isBounded(swept)) return;
    using Vector = typename SweptRow<kRows>::Vector;
    const Vector wanted = swept.lambda - factor_->solution.template segment<kRows>(first);
    const Vector inside = clamped<kRows>(swept, wanted);
    if (inside == wanted) return;
    give(swept, Vector(inside - swept.lambda), moved);
    swept.lambda = inside;
    swept.held = any = true;
  });
  for (SoftRow* row : contacts_) {
    const double wanted = row->lambda - factor_->solution[at++];
    if (row->held || wanted >= 0) continue;
    giveTo(*row, -row->lambda * row->n, moved);
    row->lambda = 0;
    row->held = any = true;
  }
  factor_->stale = factor_->stale || any;
  return any;
}

// Of a contact: c at the substep's end, or the speed with which it closes.
double Deformable::errorNow(const SoftRow& row, bool positions,
                            std::span<const Displacement> moved) const {
  const double rate = row.n.dot(slipOf(row, moved));
  return positions ? row.gap + rate - std::min(row.gap + push_, 0.0) : row.open + rate;
}

// A row at its bound is free where it would move into what it may do. True: some are no longer as
// they were.
bool Deformable::chooseContacts(bool positions, bool first, std::span<const Displacement> moved) {
  bool any = false;
  for (SoftRow* row : contacts_) {
    const bool carried = first ? !row->held : row->lambda > 0;
    const bool held = !carried && errorNow(*row, positions, moved) >= 0;
    any = any || held != row->held;
    row->held = held;
  }
  return any;
}

void Deformable::chooseFree(bool positions, bool first, std::span<const Displacement> moved) {
  factor_->stale = chooseContacts(positions, first, moved) || factor_->stale;
  if (!positions) return;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (!swept.swept || !isBounded(swept)) return;
    using Vector = typename SweptRow<kRows>::Vector;
    const Vector wanted = swept.lambda - rowError(swept, true, moved);
    const bool held = swept.lambda.isZero(0) && swept.pulled.isZero(0) &&
                      clamped<kRows>(swept, wanted) == swept.lambda;
    factor_->stale = factor_->stale || held != swept.held;
    swept.held = held;
  });
}

// Of the quadratic program at what was evaluated last, for the change d of u and for lambda itself:
//   (M + K) d - J^T lambda = -M (u - u_0),   J d + alpha lambda = -c
void Deformable::aimAtPositions(std::span<const Displacement> moved) {
  MeshFactor& f = *factor_;
  f.right.setZero();
  for (std::size_t k = 0; k < solved_.size(); ++k) {
    const Displacement& m = moved[solved_[k]];
    f.right.segment<3>(unknown_[k]) = -mass_[k] * (m.u - from_[k].u);
    if (turns_[k]) {
      f.right.segment<3>(unknown_[k] + 3) = -(inertia_[k] * (m.theta - from_[k].theta));
    }
  }
  int at = unknowns_;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (swept.swept && !swept.held) {
      f.right.template segment<kRows>(at) =
          (repeats_ || givesInLine(swept) ? 0 : kRedundancy) * swept.own * swept.lambda -
          swept.constant - along(swept, moved);
    } else if (swept.swept && !swept.next.isZero(0)) {
      for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
        const int place = placeOf(swept.bodies[b]);
        if (place < 0) continue;
        const int to = unknown_[place];
        if (swept.moves) {
          f.right.segment<3>(to) += swept.linear[b].j.transpose() * swept.next;
        }
        if (swept.turns) {
          if (turns_[place]) {
            f.right.segment<3>(to + 3) += swept.angular[b].j.transpose() * swept.next;
          }
        }
      }
    }
    at += kRows;
  });
  for (const SoftRow* row : contacts_) {
    f.right[at] =
        row->held ? 0 : kRedundancy / row->inverse * row->lambda - errorNow(*row, true, moved);
    ++at;
  }
}

// The row's J times d.
template <int kRows>
typename SweptRow<kRows>::Vector Deformable::changeAlong(const SweptRow<kRows>& swept) const {
  typename SweptRow<kRows>::Vector sum = SweptRow<kRows>::Vector::Zero();
  for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
    const int place = placeOf(swept.bodies[b]);
    if (place < 0) continue;
    const auto& d = factor_->solution;
    if (swept.moves) sum += swept.linear[b].j * d.template segment<3>(unknown_[place]);
    if (swept.turns) {
      if (turns_[place]) {
        sum += swept.angular[b].j * d.template segment<3>(unknown_[place] + 3);
      }
    }
  }
  return sum;
}

// d.
Displacement Deformable::changeOf(BodyId body) const {
  Displacement change{Vec3::Zero(), Vec3::Zero()};
  const int place = placeOf(body);
  if (place < 0) return change;
  if (points_) {
    const int turn = points_->turn[place];
    change.u = points_->change[place];
    if (turn >= 0) change.theta = points_->change[turn];
    return change;
  }
  change.u = factor_->solution.segment<3>(unknown_[place]);
  if (turns_[place]) change.theta = factor_->solution.segment<3>(unknown_[place] + 3);
  return change;
}

double Deformable::changeAlong(const SoftRow& row) const {
  const Displacement body = changeOf(row.body);
  return row.n.dot((1 - row.along) * changeOf(row.from).u + row.along * changeOf(row.to).u -
                   body.u) -
         row.arm.cross(row.n).dot(body.theta);
}

// Primal-dual: rows that the solution takes past a bound are held there, those held that it moves
// into what they may do are free. Contacts that were held again stay so, where they could go on in
// circles: what overlaps then does so by as much as those that press leave it. False: there is
// none.
bool Deformable::chooseAgain(bool isLate, std::span<const Displacement> moved) {
  bool any = false;
  int at = unknowns_;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    const int first = at;
    at += kRows;
    if (!swept.swept) return;
    using Vector = typename SweptRow<kRows>::Vector;
    if (swept.held) {
      const Vector error =
          swept.constant + along(swept, moved) + changeAlong(swept) + swept.alpha * swept.next;
      if (clamped<kRows>(swept, Vector(swept.next - error)) == swept.next) return;
      swept.held = false;
      any = true;
      return;
    }
    const Vector wanted = -factor_->solution.template segment<kRows>(first);
    swept.next = wanted;
    if (!isBounded(swept)) return;
    swept.next = clamped<kRows>(swept, wanted);
    if (swept.next != wanted) swept.held = any = true;
  });
  for (SoftRow* row : contacts_) {
    const double wanted = -factor_->solution[at++];
    if (row->held) {
      if (isLate && row->isTried) continue;
      if (errorNow(*row, true, moved) + changeAlong(*row) >= 0) continue;
      row->held = false;
      any = true;
      continue;
    }
    row->next = std::max(wanted, 0.0);
    if (wanted < 0) row->held = row->isTried = any = true;
  }
  factor_->stale = factor_->stale || any;
  return any;
}

// The part of d by which no piece between two points turns so far that the rows, which were
// evaluated before, say nothing of where it ends.
double Deformable::shareOfStep(std::span<const Pose> pose,
                               std::span<const Displacement> moved) const {
  double most = 0;
  for (const auto& [a, b] : pieces_) {
    const Vec3 now = pose[b].x + moved[b].u - pose[a].x - moved[a].u,
               by = changeOf(b).u - changeOf(a).u;
    const double squared = now.squaredNorm();
    if (squared > 0) most = std::max(most, now.cross(by).norm() / squared);
  }
  return most > kFarTurn ? kFarTurn / most : 1;
}

void Deformable::takePositions(double share, std::span<Displacement> moved) {
  MeshFactor& f = *factor_;
  for (std::size_t k = 0; k < solved_.size(); ++k) {
    moved[solved_[k]].u += share * f.solution.segment<3>(unknown_[k]);
    if (turns_[k]) moved[solved_[k]].theta += share * f.solution.segment<3>(unknown_[k] + 3);
  }
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (swept.swept) swept.lambda += share * (swept.next - swept.lambda);
  });
  for (SoftRow* row : contacts_) row->lambda += share * (row->next - row->lambda);
}

// Of rows that repeat each other what they share grows to 1/kRedundancy of what they disagree by,
// and its rounding would move all of the bodies.
void Deformable::solveFactor() {
  MeshFactor& f = *factor_;
  f.factor.solve(f.right, f.solution);
  if (repeats_) f.factor.refine(f.right, f.solution);
}

// Which rows are at a bound, and what solves the others.
void Deformable::solveProgram(bool first, std::span<const Displacement> moved) {
  MeshFactor& f = *factor_;
  chooseFree(true, first, moved);
  for (int round = 1;; ++round) {
    if (f.stale) factorize(true);
    aimAtPositions(moved);
    solveFactor();
    const bool isLate = 2 * round > kMostRounds;
    if (!chooseAgain(isLate, moved) || round == kMostRounds) return;
  }
}

void Deformable::solveAllPositions(const JointStage& stage) {
  constexpr double kClosed = 1e-7;  // its square, what the next step would change, is rounding
  if (found_ != laid_) {
    takeLaid();
    unknown_.clear();
    factor_->factor.forget();
  }
  evaluate(stage, true);
  noteStart(stage.moved);
  for (int step = 1;; ++step) {
    solveProgram(step == 1, stage.moved);
    const double share = shareOfStep(stage.pose, stage.moved);
    takePositions(share, stage.moved);
    if (step == kMostSteps || (share == 1 && isClosed(stage.moved, kClosed))) return;
    evaluate(stage, false);
  }
}

// Where Newton's method starts.
void Deformable::noteStart(std::span<const Displacement> moved) {
  from_.clear();
  for (const BodyId i : solved_) from_.push_back(moved[i]);
}

// What the last step of Newton's changed is nothing to the way that was made, or was taken back of
// what the bodies would have moved by on their own.
bool Deformable::isClosed(std::span<const Displacement> moved, double closed) const {
  double change = 0, way = 0;
  for (std::size_t k = 0; k < solved_.size(); ++k) {
    change = std::max(change, changeOf(solved_[k]).u.squaredNorm());
    way = std::max({way, moved[solved_[k]].u.squaredNorm(), from_[k].u.squaredNorm()});
  }
  return !(change > closed * closed * way);
}

void Deformable::solveVelocities(std::span<Displacement> moved) {
  constexpr bool positions = false;
  MeshFactor& f = *factor_;
  chooseFree(positions, false, moved);
  for (int round = 1;; ++round) {
    if (f.stale) factorize(positions);
    f.right.setZero();
    int at = unknowns_;
    forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
      if (swept.swept && !swept.held) {
        f.right.template segment<kRows>(at) = -rowError(swept, positions, moved);
      }
      at += kRows;
    });
    for (const SoftRow* row : contacts_) {
      f.right[at++] = row->held ? 0 : -errorNow(*row, positions, moved);
    }
    solveFactor();
    if (round == kMostRounds || !holdAtBounds(moved)) break;
  }
  for (std::size_t k = 0; k < solved_.size(); ++k) {
    moved[solved_[k]].u += f.solution.segment<3>(unknown_[k]);
    if (turns_[k]) moved[solved_[k]].theta += f.solution.segment<3>(unknown_[k] + 3);
  }
  int at = unknowns_;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (swept.swept && !swept.held) {
      swept.lambda -= f.solution.template segment<kRows>(at);
    }
    at += kRows;
  });
  for (SoftRow* row : contacts_) {
    const double change = -f.solution[at++];
    if (!row->held) row->lambda += change;
  }
}

}  // namespace physics
