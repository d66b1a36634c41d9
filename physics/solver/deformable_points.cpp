// What holds the points of a cloth, with what touches them: all of it at once.
#include <algorithm>

#include "physics/base/inverse.h"
#include "physics/solver/deformable.h"

namespace physics {

using namespace swept;

namespace {

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
template <int kRows>
typename SweptRow<kRows>::Matrix stiffnessOf(const SweptRow<kRows>& swept, double gives) {
  typename SweptRow<kRows>::Matrix alpha = swept.alpha;
  alpha.diagonal().array() += gives * swept.own;
  return inverseOrNan(alpha);
}

double stiffnessOf(const SoftRow& row) { return row.inverse / kRedundancy; }

}  // namespace

Mat3 turningStiffness(const Vec3& d, double pull, double length) {
  if (!(pull > 0) || !(length > 0)) return Mat3::Zero();
  return pull / length * (Mat3::Identity() - d * d.transpose());
}

// Which rows are solved at once: those that hold points, unless their factor would fill up.
void Deformable::choosePoints(const Kinds& kinds, std::span<const InverseMass> masses) {
  bool any = false;  // between two that move
  const auto isPoint = [&](BodyId i) { return !(masses[i].m > 0) || masses[i].inertia.isZero(0); };
  forEachRow(rows_, [&](SweptItem& swept) {
    if (!swept.isPair) return;
    const BodyId a = swept.bodies[0], b = swept.bodies[1];
    swept.isAtOnce = swept.isBothWays && isPoint(a) && isPoint(b);
    any = any || (swept.isAtOnce && masses[a].m > 0 && masses[b].m > 0);
  });
  if (any) {
    points_ = std::make_unique<PointFactor>();
    findImplied(kinds);
    takeLengthsAtOnce();
    layOutPoints();
    if (points_->factor.fill() <= kMostFill) return;
    points_.reset();
  }
  forEachRow(rows_, [&](SweptItem& swept) { swept.isAtOnce = swept.isImplied = false; });
}

// f(swept, row) of what is solved at once, in the order of the factor's rows.
template <class F>
void Deformable::forEachPair(F&& f) {
  auto next = points_->rows.begin();
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    if (swept.isPair && swept.isAtOnce) f(swept, *next++);
  });
}

// f(row, column, block) of what a contact that presses by its stiffness adds to the matrix, always
// the same ones in the same order: of its points, its body, and that body's turn.
template <class F>
void Deformable::forEachBlockOf(const PointFactor::Pressed& pressed, F&& f) const {
  const SoftRow& row = *pressed.row;
  const auto sides = sidesOf(row);
  const double stiffness = row.held ? 0 : stiffnessOf(row);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b <= a; ++b) {
      const bool isLower = pressed.place[a] > pressed.place[b];
      const int more = isLower ? a : b, less = isLower ? b : a;
      if (pressed.place[less] < 0) continue;
      const Mat3 block = stiffness * sides[more] * sides[less].transpose();
      f(pressed.place[more], pressed.place[less], block);
    }
  }
}

// Bodies that touch have places of their own, those that turn two.
void Deformable::layOutPoints() {
  PointFactor& f = *points_;
  int count = static_cast<int>(solved_.size());
  f.turn.assign(count, -1);
  for (PointFactor::Pressed& pressed : f.pressed) {
    const SoftRow& row = *pressed.row;
    const int body = placeOf(row.body);
    if (body >= 0 && f.turn[body] < 0 && !row.inertia.isZero(0)) f.turn[body] = count++;
    pressed.place = {placeOf(row.from), row.from == row.to ? -1 : placeOf(row.to), body,
                     body < 0 ? -1 : f.turn[body]};
  }
  std::vector<std::array<int, 2>> entries;
  const auto add = [&](int row, int column, const auto&) { entries.push_back({row, column}); };
  for (int k = 0; k < count; ++k) add(k, k, 0);
  std::size_t rows = 0;
  forEachRow(rows_, [&](SweptItem& swept) {
    if (!swept.isPair || !swept.isAtOnce) return;
    swept.place = {placeOf(swept.bodies[0]), placeOf(swept.bodies[1])};
    forEachBlock(swept.place, add);
    ++rows;
  });
  f.rows.resize(rows);
  std::vector<std::array<int, 2>> pieces;
  layOutLengths(pieces);
  for (const auto& piece : pieces) forEachBlock(piece, add);
  for (const PointFactor::Pressed& pressed : f.pressed) forEachBlockOf(pressed, add);
  f.factor.layOut(entries);
  f.change.resize(count);
  f.massive.resize(count);
}

void Deformable::takePressed() {
  PointFactor& f = *points_;
  const bool isLaid = found_ == laid_;
  if (!isLaid) takeLaid();
  f.pressed.resize(contacts_.size());
  for (std::size_t k = 0; k < contacts_.size(); ++k) f.pressed[k].row = contacts_[k];
  if (!isLaid) layOutPoints();
}

// M + J^T alpha^-1 J + K.
void Deformable::factorizePoints() {
  PointFactor& f = *points_;
  f.stale = false;
  f.factor.begin();
  for (const Mat3& mass : f.massive) f.factor.give(mass);
  forEachPair([&](const SweptItem& swept, const PointFactor::Row& row) {
    forEachBlock(swept.place, [&](int, int, double sign) { f.factor.give(sign * row.stiffness); });
  });
  for (PointFactor::Length& length : f.lengths) {
    length.answer.clear();
    for (std::size_t p = 1; p < length.place.size(); ++p) {
      const Mat3& block = length.turning[p - 1];
      forEachBlock({length.place[p - 1], length.place[p]},
                   [&](int, int, double sign) { f.factor.give(sign * block); });
    }
  }
  for (const PointFactor::Pressed& pressed : f.pressed) {
    forEachBlockOf(pressed, [&](int, int, const Mat3& block) { f.factor.give(block); });
  }
  f.factor.factorize();
}

// What was evaluated, of each row.
void Deformable::takeStiffness(std::span<const JointMass> masses, bool first) {
  PointFactor& f = *points_;
  f.stale = true;
  for (std::size_t k = 0; k < solved_.size(); ++k) {
    const JointMass& mass = masses[solved_[k]];
    f.massive[k] = Mat3::Identity() / mass.inverse;
    if (f.turn[k] >= 0) f.massive[f.turn[k]] = inverseOrNan(mass.inertia);
  }
  forEachPair([&]<int kRows>(SweptRow<kRows>& swept, PointFactor::Row& row) {
    if (first) row.given.setZero();
    row.stiffness.setZero();
    row.turning.setZero();
    if (!swept.swept) return;
    const auto& j = swept.linear[0].j;
    if constexpr (kRows == 1) {
      if (swept.isLink) {
        row.turning = turningStiffness(j.transpose(), -swept.pulled[0], swept.length);
      }
    }
    row.stiffness = row.turning;
    row.stiffness.noalias() += j.transpose() * stiffnessOf(swept, gives_) * j;
  });
  takeLengths(first);
}

Vec3 Deformable::apartBy(const SweptItem& swept) const {
  Vec3 apart = Vec3::Zero();
  const auto [a, b] = swept.place;
  if (a >= 0) apart += points_->change[a];
  if (b >= 0) apart -= points_->change[b];
  return apart;
}

// The part of d by which no link turns so far that the rows, which were evaluated before, say
// nothing of where it ends.
double Deformable::shareOfChange() {
  double most = 0;
  for (const SweptRow<1>& swept : std::get<std::vector<SweptRow<1>>>(rows_.lists)) {
    if (!swept.isLink || !swept.isAtOnce || !swept.swept || !(swept.length > 0)) continue;
    const Vec3 across = swept.linear[0].j.transpose().cross(apartBy(swept));
    most = std::max(most, across.norm() / swept.length);
  }
  return most > kFarTurn ? kFarTurn / most : 1;
}

// K pushes back what has moved on from here.
void Deformable::turnFrom(std::span<const Displacement> moved) {
  points_->from.clear();
  for (const BodyId i : solved_) points_->from.push_back(moved[i].u);
}

Vec3 Deformable::turnedBy(int place, std::span<const Displacement> moved) const {
  if (place < 0) return Vec3::Zero();
  return moved[solved_[place]].u - points_->from[place];
}

// What pushes on the bodies besides what they have been given, in the right-hand side:
//   J^T (lambda - alpha^-1 c) - K (u - u_from) - given,   c where u is now
void Deformable::aimAtPoints(bool positions, std::span<const Displacement> moved) {
  PointFactor& f = *points_;
  std::fill(f.change.begin(), f.change.end(), Vec3::Zero());
  forEachPair([&]<int kRows>(SweptRow<kRows>& swept, PointFactor::Row& row) {
    if (!swept.swept) return;
    const auto [a, b] = swept.place;
    const auto& j = swept.linear[0].j;
    const typename SweptRow<kRows>::Vector error = swept.constant + along(swept, moved) +
                                                   swept.alpha * swept.lambda +
                                                   gives_ * swept.own * swept.lambda;
    swept.next = -(stiffnessOf(swept, gives_) * error);
    row.next = j.transpose() * (swept.lambda + swept.next) -
               row.turning * (turnedBy(a, moved) - turnedBy(b, moved)) - row.given;
    if (a >= 0) f.change[a] += row.next;
    if (b >= 0) f.change[b] -= row.next;
  });
  aimAtLengths(moved);
  for (const PointFactor::Pressed& pressed : f.pressed) {
    SoftRow& row = *pressed.row;
    row.next = row.held ? -row.lambda : -stiffnessOf(row) * errorNow(row, positions, moved);
    const auto sides = sidesOf(row);
    for (int k = 0; k < 4; ++k) {
      if (pressed.place[k] >= 0) f.change[pressed.place[k]] += row.next * sides[k];
    }
  }
}

// By what each row gives to both of its ends: their momentum stays, to rounding.
void Deformable::takeChange(double share, std::span<const JointMass> masses,
                            std::span<Displacement> moved) {
  forEachPair([&]<int kRows>(SweptRow<kRows>& swept, PointFactor::Row& row) {
    if (!swept.swept) return;
    const Vec3 apart = apartBy(swept), push = share * (row.next - row.stiffness * apart);
    row.given += push;
    swept.lambda += share * (swept.next - stiffnessOf(swept, gives_) * (swept.linear[0].j * apart));
    const BodyId a = swept.bodies[0], b = swept.bodies[1];
    moved[a].u += masses[a].inverse * push;
    moved[b].u -= masses[b].inverse * push;
  });
  takeLengthChange(share, masses, moved);
  for (SoftRow* row : contacts_) {
    const double change =
        share * (row->held ? row->next : row->next - stiffnessOf(*row) * changeAlong(*row));
    row->lambda += change;
    giveTo(*row, change * row->n, moved);
  }
}

// Primal-dual, as chooseAgain, but that none is tried twice: each round has a factor of its own.
bool Deformable::choosePressed(bool positions, std::span<const Displacement> moved) {
  bool any = false;
  for (SoftRow* row : contacts_) {
    const double rate = changeAlong(*row);
    const bool frees = row->held && !row->isTried && errorNow(*row, positions, moved) + rate < 0;
    const bool holds = !row->held && row->lambda + row->next - stiffnessOf(*row) * rate < 0;
    if (!frees && !holds) continue;
    row->held = holds;
    row->isTried = row->isTried || holds;
    any = true;
  }
  return any;
}

// The change d of u, and the share of it that was taken.
double Deformable::solvePoints(bool positions, bool first, std::span<const JointMass> masses,
                               std::span<Displacement> moved) {
  PointFactor& f = *points_;
  f.stale = chooseContacts(positions, first, moved) || f.stale;
  for (int round = 1;; ++round) {
    if (f.stale) factorizePoints();
    aimAtPoints(positions, moved);
    f.factor.solve(f.change);
    solveLengths(moved);
    if (round == kMostRounds) break;
    f.stale = choosePressed(positions, moved);
    if (!chooseLengths(positions, moved) && !f.stale) break;
  }
  const double share = positions ? shareOfChange() : 1;
  takeChange(share, masses, moved);
  return share;
}

// From here on: J u = 0 of what holds, and what gives way goes on as it did, while friction moves
// it.
void Deformable::preparePointVelocities(std::span<const Displacement> moved) {
  turnFrom(moved);
  forEachPair([&]<int kRows>(SweptRow<kRows>& swept, PointFactor::Row& row) {
    if (!swept.swept) return;
    const bool gives = !swept.alpha.isZero(0);
    swept.constant = -(gives_ * swept.own * swept.lambda);
    if (gives) swept.constant -= along(swept, moved) + swept.alpha * swept.lambda;
    row.given = swept.linear[0].j.transpose() * swept.lambda;
  });
  prepareLengthVelocities();
}

// Two steps of Newton's: what is left of the first is of second order in how far pieces turn, and
// of what is stiff that is energy.
void Deformable::solvePointPositions(const JointStage& stage, double closed) {
  evaluate(stage, true);
  noteStart(stage.moved);
  for (int step = 1;; ++step) {
    turnFrom(stage.moved);
    const double share = solvePoints(true, step == 1, stage.masses, stage.moved);
    const bool isClose = step > 1 && share == 1 && isClosed(stage.moved, closed);
    if (step == kMostSteps || isClose) return;
    evaluate(stage, false);
  }
}

}  // namespace physics
