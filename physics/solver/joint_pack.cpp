// Articulations of equal topology through the stages of a substep: what differs from lane to lane
// is here, what does not is in the kernels.
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/solver/articulation.h"
#include "physics/solver/joint_lanes.h"

namespace physics {
namespace {

constexpr int kMostRounds = 6;    // of finding which rows are at a bound
constexpr int kMostSteps = 5;     // of Newton's, after the first
constexpr double kOpened = 0.01;  // of its arm: a gap that no joint has where a step begins

}  // namespace

template <int W>
void JointPack<W>::take(std::span<Articulation* const> articulations) {
  lanes_ = static_cast<int>(articulations.size());
  std::array<Articulation*, W> of;
  for (int l = 0; l < W; ++l) of[l] = articulations[l < lanes_ ? l : 0];
  const bool isNew = topology_ != of[0]->topology_;
  const std::array<Articulation*, W> were = of_;
  of_ = of;
  for (int l = 0; l < lanes_; ++l) of_[l]->isOpened_ = false;
  ids_.resize(of[0]->all_.size() * W);
  for (std::size_t i = 0; i < ids_.size(); ++i) ids_[i] = of[i % W]->all_[i / W];
  if (isNew) {
    topology_ = of_[0]->topology_;
    bodies_.assign(topology_->bodyCount, JointBody<W>{});
    rows_.assign(topology_->shapes.size(), JointLanes<W>{});
    entries_.assign(topology_->lower, Num<W>{});
    scaled_.assign(topology_->lower, Num<W>{});
    factors_.assign(rows_.size(), JointFactor<W>{});
    factored_.assign(bodies_.size(), JointFactored<W>{});
    states_.assign(topology_->shapes.size(), State{});
    used_.resize(rows_.size());
    steps_.lambda.resize(rows_.size());
    steps_.u.resize(topology_->bodyCount);
    steps_.theta.resize(topology_->bodyCount);
    usedCounts_.resize(rows_.size());
    usedBelow_.resize(topology_->below.size());
    const std::size_t tail = rows_.size() - topology_->tailStart;
    tail_.resize(tail * (tail + 1) / 2);
    tailWork_.resize(tail_.size() + 3 * tail);
    tailGives_.resize(tail);
    tailPlaces_.resize(tail);
  }
  takePulls();
  for (JointLanes<W>& row : rows_) std::fill(std::begin(row.left), std::end(row.left), Num<W>{});
  for (int l = 0; l < W; ++l) {
    if (!isNew && of_[l] == were[l]) continue;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      JointLanes<W>& row = rows_[i];
      const JointKind& kind = of_[l]->kinds_[i];
      row.regularisation.v[l] = kind.regularisation;
      row.longest.v[l] = std::numeric_limits<double>::infinity();
      for (int k = 0; k < kJointFixed; ++k) row.fixed[k].v[l] = kind.fixed[k];
    }
  }
}

template <int W>
void JointPack<W>::takePulls() {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const JointShape& shape = topology_->shapes[i];
    JointLanes<W>& row = rows_[i];
    for (int l = 0; l < W; ++l) {
      const Articulation::Pull& pull = of_[l]->pulls_[i];
      write(row.lambda, l, pull.lambda);
      if (!shape.pulls) continue;
      for (int b = 0; b < shape.bodyCount; ++b) {
        write(row.arm[b], l, pull.arm[b]);
        if (shape.hasLinear) writeRows(row.linear[b], l, pull.linear[b], shape.rows);
      }
    }
  }
}

template <int W>
JointView<W> JointPack<W>::view() {
  const std::size_t triangle = tail_.size(), tail = tailPlaces_.size();
  Num<W>* work = tailWork_.data();
  return {bodies_.data(),
          rows_.data(),
          factors_.data(),
          factored_.data(),
          entries_.data(),
          scaled_.data(),
          static_cast<int>(bodies_.size()),
          static_cast<int>(rows_.size()),
          topology_->tailStart,
          topology_->shapes.data(),
          topology_->columns.data(),
          topology_->below.data(),
          topology_->updatesAt.data(),
          topology_->meetings.data(),
          &open_,
          &anew_,
          used_.data(),
          usedBelow_.data(),
          usedCounts_.data(),
          {tail_.data(), work, work + triangle, work + triangle + tail, work + triangle + 2 * tail,
           tailGives_.data(), tailPlaces_.data(), &tailCount_, &tailFactored_,
           topology_->tail.data(), static_cast<int>(topology_->tail.size())}};
}

template <int W>
void JointPack<W>::restorePoses(const JointStage& stage) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    for (int l = 0; l < lanes_; ++l) {
      stage.pose[ids_[i * W + l]] = {read(bodies_[i].startX, l), readTurn(bodies_[i].startQ, l)};
    }
  }
}

// Trial poses: of what joints move, and of what moves by itself.
template <int W>
void JointPack<W>::place(bool back) {
  jointKernels<W>().place(view());
  if (back) jointKernels<W>().turnBack(view());
  jointKernels<W>().seeGaps(view(), back);
  seenSince_ = true;
}

template <int W>
void JointPack<W>::stiffen(std::span<Mat3> stiffness) {
  jointKernels<W>().stiffen(view());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    for (int l = 0; topology_->moves[i] && l < lanes_; ++l) {
      stiffness[ids_[i * W + l]] = readSymmetric(bodies_[i].stiffness, l);
    }
  }
}

// `all`: also those that are held, which say whether they are free.
template <int W>
void JointPack<W>::seeOthers(const JointStage& stage, bool all, bool inPositions) {
  JointRow row;
  for (const int i : topology_->others) {
    for (int l = 0; l < lanes_; ++l) {
      if (!all && !(rows_[i].free.v[l] > 0)) continue;
      evaluateRow(stage.kinds, of_[l]->refs_[i], {stage.pose, stage.start, stage.h}, row);
      states_[i].active[l] = row.active;
      if (!row.active) continue;
      states_[i].role[l] = row.role;
      takeError(l, row, rows_[i]);
      const bool keepsWay = inPositions && states_[i].hasStart[l];
      if (!keepsWay) takeGradients(topology_->shapes[i], l, row, rows_[i]);
    }
  }
}

// Of a position stage: a force pulls along the way that the substep begins with. With v = u / h it
// gives no angular momentum then,
//   sum x_1 x m v = sum (x_0 + u) x m u / h = sum x_0 x (h m v_0 + J_0^T lambda) / h
template <int W>
void JointPack<W>::seeWays(const JointStage& stage) {
  JointRow row;
  for (const int i : topology_->others) {
    if (!topology_->shapes[i].isWay) continue;
    for (int l = 0; l < lanes_; ++l) {
      evaluateRow(stage.kinds, of_[l]->refs_[i], {stage.pose, stage.start, stage.h}, row);
      states_[i].hasStart[l] = row.active;
      if (row.active) takeGradients(topology_->shapes[i], l, row, rows_[i]);
    }
  }
}

template <int W>
void JointPack<W>::setFree(int i, int l, bool free) {
  if ((rows_[i].free.v[l] > 0) == free) return;
  rows_[i].free.v[l] = free ? 1 : 0;
  stale_[l] = stale_[l] || i < topology_->tailStart;  // the tail leaves out what is held
}

template <int W>
bool JointPack<W>::givesWay(int i, int l) const {
  if (rows_[i].regularisation.v[l] > 0 || !topology_->shapes[i].stands) return true;
  return states_[i].role[l] != JointRow::Role::kConstraint || hasAlpha(rows_[i], l);
}

// What of the errors at X^t a substep leaves to later ones, where they are taken back no faster
// than `most` [m, rad] at a time, and this part of those of limits not at all.
template <int W>
void JointPack<W>::leave(const JointStage& stage, double most, double ofLimits) {
  const auto isOne = [](const JointShape& shape) { return isLimit(shape); };
  const bool some =
      std::isfinite(most) ||
      (ofLimits > 0 && std::any_of(topology_->shapes.begin(), topology_->shapes.end(), isOne));
  if (!some) return;
  seeGaps(stage);
  jointKernels<W>().seeLimits(view(), true);
  seeOthers(stage, true, false);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const bool isGap = topology_->shapes[i].isGap;
    const bool isKernels = topology_->shapes[i].seen != JointSeen::kByKind;
    for (int l = 0; l < lanes_; ++l) {
      const Vec3 c = read(rows_[i].c, l);
      const double error = c.norm();
      const bool speaks =
          isKernels || (states_[i].active[l] && states_[i].role[l] == JointRow::Role::kConstraint);
      const bool holds =
          speaks && (isGap || clamped(topology_->shapes[i], rows_[i], l, -c) != Vec3::Zero());
      const double ofThis = isLimit(topology_->shapes[i]) ? ofLimits : 0;
      const double part = holds && error > 0 ? std::max(1 - most / error, ofThis) : 0;
      write(rows_[i].left, l, (part * c).eval());
    }
  }
}

// Of what kinds evaluate: loads are given, and all else that is active is solved for.
template <int W>
void JointPack<W>::giveLoads() {
  for (const int i : topology_->others) {
    JointLanes<W>& row = rows_[i];
    for (int l = 0; l < lanes_; ++l) {
      if (!states_[i].active[l]) continue;
      if (states_[i].role[l] != JointRow::Role::kLoad) {
        row.free.v[l] = 1;
        continue;
      }
      const Vec3 lambda = clamped(topology_->shapes[i], rows_[i], l, read(row.c, l));
      write(row.lambda, l, lambda);
      give<W>(topology_->shapes[i], rows_[i], l, lambda, bodies_);
    }
  }
  stale_.fill(true);
}

// A constraint at its bound is free where it would move into what it may do.
template <int W>
void JointPack<W>::chooseFree() {
  jointKernels<W>().chooseLimits(view());
  for (const int i : topology_->others) {
    const JointLanes<W>& row = rows_[i];
    for (int l = 0; l < lanes_; ++l) {
      if (!states_[i].active[l] || states_[i].role[l] != JointRow::Role::kConstraint) continue;
      if (!isBounded(rows_[i], l)) continue;
      const Vec3 wanted = read(row.left, l) - read(row.c, l);
      setFree(i, l, clamped(topology_->shapes[i], rows_[i], l, wanted) != Vec3::Zero());
    }
  }
}

template <int W>
void JointPack<W>::findUsed() {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto& free = rows_[i].free.v;
    used_[i] = std::any_of(free, free + lanes_, [](double f) { return f > 0; });
  }
}

// Only lanes whose free rows are others than the factor's take what J is now.
template <int W>
void JointPack<W>::factorizeStale() {
  const auto isStale = [](bool stale) { return stale; };
  const auto end = stale_.begin() + lanes_;
  if (std::none_of(stale_.begin(), end, isStale)) return;
  const bool all = !seenSince_ || std::all_of(stale_.begin(), end, isStale);
  for (int l = 0; l < W; ++l) anew_.v[l] = all || stale_[l] ? 1 : 0;
  findUsed();
  jointKernels<W>().factorize(view());
  if (all) seenSince_ = false;
  stale_.fill(false);
}

// Rows that the solution would take past a bound are held there, and the others are to be solved
// for again: what one row gives up, the rows around it have not counted on.
template <int W>
bool JointPack<W>::holdAtBounds() {
  bool any = false;
  for (const int i : topology_->bounded) {
    if (!used_[i]) continue;
    JointLanes<W>& row = rows_[i];
    for (int l = 0; l < lanes_; ++l) {
      if (!(open_.v[l] > 0) || !(row.free.v[l] > 0) || !isBounded(row, l)) continue;
      const Vec3 lambda = read(row.lambda, l), wanted = lambda + read(row.right, l);
      const Vec3 inside = clamped(topology_->shapes[i], rows_[i], l, wanted);
      if (inside == wanted) continue;
      if (inside != lambda) give<W>(topology_->shapes[i], rows_[i], l, inside - lambda, bodies_);
      write(row.lambda, l, inside);
      write(row.right, l, Vec3::Zero());
      setFree(i, l, false);
      any = true;
    }
  }
  return any;
}

template <int W>
void JointPack<W>::openAll() {
  for (int l = 0; l < W; ++l) open_.v[l] = l < lanes_ ? 1 : 0;
}

template <int W>
void JointPack<W>::open(std::span<const double> wanted) {
  for (int l = 0; l < W; ++l) {
    open_.v[l] = l < lanes_ && wanted[of_[l]->bodies_.front()] > 0 ? 1 : 0;
  }
}

template <int W>
bool JointPack<W>::isNoneOpen() const {
  return std::none_of(open_.v, open_.v + W, [](double open) { return open > 0; });
}

template <int W>
void JointPack<W>::see(const JointStage& stage, bool first) {
  const JointKernels<W>& kernels = jointKernels<W>();
  place(first && !stage.spin.empty());
  kernels.seeLimits(view(), first);
  if (topology_->others.empty()) return;
  if (first) seeWays(stage);
  scatterPoses<W>(ids_, lanes_, bodies_, stage.pose);
  seeOthers(stage, first, true);
  restorePoses(stage);
}

template <int W>
void JointPack<W>::noteSeen() {
  for (JointBody<W>& body : bodies_) {
    std::copy(std::begin(body.u), std::end(body.u), std::begin(body.seenU));
    std::copy(std::begin(body.theta), std::end(body.theta), std::begin(body.seenTheta));
  }
}

// A step of Newton's from what was seen last.
template <int W>
void JointPack<W>::step() {
  factorizeStale();
  jointKernels<W>().aimAtErrors(view());
  stepToAim();
}

// The same, of what is aimed at already.
template <int W>
void JointPack<W>::stepToAim() {
  const JointKernels<W>& kernels = jointKernels<W>();
  for (int round = 1;; ++round) {
    kernels.substitute(view());
    if (round == kMostRounds || !holdAtBounds()) break;
    factorizeStale();
    kernels.aimAtErrors(view());
  }
  kernels.apply(view());
}

template <int W>
void JointPack<W>::seeGaps(const JointStage& stage) {
  gatherPoses<W>(ids_, stage.pose, bodies_);
  jointKernels<W>().seeGaps(view(), false);
}

template <int W>
void JointPack<W>::seeStart(const JointStage& stage) {
  seeGaps(stage);
  for (int l = 0; l < lanes_; ++l) apart_[l] = hasGap(l, kOpened);
}

template <int W>
bool JointPack<W>::areNearlyClosed(const JointStage& stage) {
  seeGaps(stage);
  for (int l = 0; l < lanes_; ++l) {
    if (hasGap(l, kNearlyClosed)) return false;
  }
  return true;
}

template <int W>
bool JointPack<W>::isApart() const {
  return std::any_of(apart_.begin(), apart_.begin() + lanes_, [](bool apart) { return apart; });
}

template <int W>
bool JointPack<W>::findApart(std::span<double> marks) const {
  for (int l = 0; l < lanes_; ++l) {
    for (const BodyId i : of_[l]->bodies_) marks[i] = apart_[l] ? 1 : 0;
  }
  return isApart();
}

// What constraints gave is left out, and what forces gave stays. Those that are together by now, at
// the end of the substep, stay so.
template <int W>
void JointPack<W>::forgetClosing(const JointStage& stage, std::span<const Displacement> predicted) {
  if (!isApart()) return;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (topology_->moves[i / W] && apart_[i % W]) stage.moved[ids_[i]] = predicted[ids_[i]];
  }
  gatherMotion<W>(ids_, stage.moved, bodies_);
  for (const int i : topology_->others) {
    for (int l = 0; l < lanes_; ++l) {
      const bool pushes = states_[i].active[l] && states_[i].role[l] == JointRow::Role::kForce;
      if (!apart_[l] || !pushes) continue;
      give<W>(topology_->shapes[i], rows_[i], l, read(rows_[i].lambda, l), bodies_);
    }
  }
  scatterMotion<W>(ids_, lanes_, topology_->moves, bodies_, stage.moved);
  const std::array<bool, W> were = apart_;
  seeStart(stage);
  for (int l = 0; l < lanes_; ++l) apart_[l] = apart_[l] && were[l];
}

template <int W>
void JointPack<W>::seePositions(const JointStage& stage) {
  openAll();
  gatherMotion<W>(ids_, stage.moved, bodies_);
  gatherMasses<W>(ids_, stage.masses, bodies_);
  gatherPoses<W>(ids_, stage.pose, bodies_);
  for (std::size_t i = 0; i < ids_.size() && !stage.spin.empty(); ++i) {
    write(bodies_[i / W].back, i % W, (stage.h * stage.spin[ids_[i]]).eval());
  }
  for (JointBody<W>& body : bodies_) {
    std::copy(std::begin(body.x), std::end(body.x), std::begin(body.startX));
    std::copy(std::begin(body.q), std::end(body.q), std::begin(body.startQ));
  }
  jointKernels<W>().begin(view());
  see(stage, true);
  noteSeen();
  giveLoads();
  chooseFree();
  scatterMotion<W>(ids_, lanes_, topology_->moves, bodies_, stage.moved);
}

template <int W>
void JointPack<W>::followPositions(const JointStage& stage) {
  openAll();
  gatherMotion<W>(ids_, stage.moved, bodies_);
  step();
  scatterMotion<W>(ids_, lanes_, topology_->moves, bodies_, stage.moved);
}

template <int W>
JointContacts JointPack<W>::contactsOf(const LaneBodies& lanes) {
  slots_.resize(ids_.size());
  for (std::size_t i = 0; i < ids_.size(); ++i) slots_[i] = lanes.slotOf[ids_[i]];
  return {slots_.data(),       lanes.motions.data(),    lanes.before.data(),
          lanes.masses.data(), topology_->moves.data(), lanes_};
}

template <int W>
void JointPack<W>::startTurns(const JointStage& stage, const LaneBodies& lanes) {
  seePositions(stage);
  followOpen(lanes);
}

template <int W>
void JointPack<W>::followPositions(const LaneBodies& lanes, std::span<const double> wanted) {
  open(wanted);
  if (!isNoneOpen()) followOpen(lanes);
}

template <int W>
void JointPack<W>::followOpen(const LaneBodies& lanes) {
  const JointContacts contacts = contactsOf(lanes);
  jointKernels<W>().takeContacts(view(), contacts);
  step();
  jointKernels<W>().tellContacts(view(), contacts);
}

template <int W>
void JointPack<W>::tell(const JointStage& stage) const {
  scatterMotion<W>(ids_, lanes_, topology_->moves, bodies_, stage.moved);
}

// What the rows of a lane are off by, at the most, squared.
template <int W>
double JointPack<W>::offOf(int l) const {
  double off = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (used_[i]) off = std::max(off, read(rows_[i].right, l).squaredNorm());
  }
  return off;
}

// From where the next step of Newton's begins.
template <int W>
void JointPack<W>::noteStep(int l, double off) {
  steps_.off[l] = off;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    write(steps_.lambda[i].data(), l, read(rows_[i].lambda, l));
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    write(steps_.u[i].data(), l, read(bodies_[i].u, l));
    write(steps_.theta[i].data(), l, read(bodies_[i].theta, l));
  }
}

// Back there, but for a share of the step.
template <int W>
void JointPack<W>::goBack(int l, double keeps) {
  const auto move = [&](Num<W>* value, const Num<W>* from) {
    const Vec3 start = read(from, l);
    write(value, l, (start + keeps * (read(value, l) - start)).eval());
  };
  for (std::size_t i = 0; i < rows_.size(); ++i) move(rows_[i].lambda, steps_.lambda[i].data());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    move(bodies_[i].u, steps_.u[i].data());
    move(bodies_[i].theta, steps_.theta[i].data());
  }
}

// As if nothing but loads pulled.
template <int W>
void JointPack<W>::goToPredicted(std::span<const Displacement> predicted, int l) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const bool isLoad = topology_->shapes[i].seen == JointSeen::kByKind && states_[i].active[l] &&
                        states_[i].role[l] == JointRow::Role::kLoad;
    if (!isLoad) write(rows_[i].lambda, l, Vec3::Zero());
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!topology_->moves[i]) continue;
    const Displacement& from = predicted[ids_[i * W + l]];
    write(bodies_[i].u, l, from.u);
    write(bodies_[i].theta, l, from.theta);
  }
}

// Of those that are far, lanes that the last step took further off keep half of it, and wait. True:
// there are some.
template <int W>
bool JointPack<W>::goBack(const Num<W>& far) {
  bool some = false;
  for (int l = 0; l < lanes_; ++l) {
    if (!(far.v[l] > 0) || !(open_.v[l] > 0)) continue;
    const double off = offOf(l);
    if (!(off > steps_.off[l])) {
      noteStep(l, off);
      continue;
    }
    goBack(l, 0.5);
    stale_[l] = true;
    open_.v[l] = 0;
    some = true;
  }
  return some;
}

template <int W>
bool JointPack<W>::hasGap(int l, double most) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!topology_->shapes[i].isGap) continue;
    const JointLanes<W>& row = rows_[i];
    const double arm2 =
        std::max(read(row.arm[0], l).squaredNorm(), read(row.arm[1], l).squaredNorm());
    const double gap2 = (read(row.c, l) - read(row.left, l)).squaredNorm();
    if (arm2 > 0 && !(gap2 <= most * most * arm2)) return true;
  }
  return false;
}

// Of lanes that are far, those whose gaps are, where none was open before, take no step that is not
// looked at: they go to where Newton's left them the least off.
template <int W>
void JointPack<W>::giveUp(const Num<W>& far) {
  given_.fill(false);
  for (int l = 0; l < lanes_; ++l) {
    given_[l] = far.v[l] > 0 && !apart_[l] && hasGap(l, kClosed);
    if (!given_[l]) continue;
    if (offOf(l) < steps_.off[l]) noteStep(l, offOf(l));
    goBack(l, 0);
    open_.v[l] = 0;
  }
}

// Those of them that are open there: the step was too long. What those that are far open move by is
// no motion, and they stay where they were predicted if they are less off there.
template <int W>
void JointPack<W>::leaveOpen(const JointStage& stage, std::span<const Displacement> predicted) {
  const auto isAny = [](const std::array<bool, W>& of) {
    return std::any_of(of.begin(), of.end(), [](bool is) { return is; });
  };
  if (!isAny(given_)) return;
  openAll();
  see(stage, false);
  std::array<bool, W> isFar{};
  for (int l = 0; l < lanes_; ++l) {
    isFar[l] = given_[l] && hasGap(l, kNearlyClosed);
    if (isFar[l]) goToPredicted(predicted, l);
  }
  if (isAny(isFar)) {
    see(stage, false);
    noteSeen();
    jointKernels<W>().aimAtErrors(view());
  }
  for (int l = 0; l < lanes_; ++l) {
    if (isFar[l] && !(offOf(l) < steps_.off[l])) goBack(l, 0);
    apart_[l] = apart_[l] || isFar[l];
  }
  gatherPoses<W>(ids_, stage.pose, bodies_);
  jointKernels<W>().seeLimits(view(), true);
  for (int l = 0; l < lanes_; ++l) {
    if (given_[l]) of_[l]->isOpened_ = of_[l]->isOpened_ || !isBeyondLimit(l);
  }
}

// What starts beyond a limit is turned back within a substep: in a shorter one, so much faster.
template <int W>
bool JointPack<W>::isBeyondLimit(int l) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!isLimit(topology_->shapes[i])) continue;
    const double c = rows_[i].c[0].v[l];
    if (rows_[i].high.v[l] == 0 && c > kOpened) return true;
    if (rows_[i].low.v[l] == 0 && c < -kOpened) return true;
  }
  return false;
}

// Newton's method, until what is off before a step is no more than kClosed. Where rows hardly
// differ, a step that closes them by a little takes bodies anywhere, and the next one further.
template <int W>
void JointPack<W>::closePositions(const JointStage& stage,
                                  std::span<const Displacement> predicted) {
  const JointKernels<W>& kernels = jointKernels<W>();
  openAll();
  gatherMotion<W>(ids_, stage.moved, bodies_);
  steps_.off.fill(std::numeric_limits<double>::infinity());
  for (int k = 0;; ++k) {
    see(stage, false);
    noteSeen();
    if (k == 0 && !stage.spin.empty()) stale_.fill(true);  // the factor is of arms turned back
    factorizeStale();
    kernels.aimAtErrors(view());
    const Num<W> open = open_;
    const bool isFar = kernels.findOpen(view(), kClosed), isLast = k == kMostSteps;
    const Num<W> far = open_;
    open_ = open;
    if (isFar && isLast) giveUp(far);
    const bool isElsewhere = isFar && (goBack(far) || isLast);
    isElsewhere ? step() : stepToAim();
    if (!isFar) break;
    open_ = far;
    if (isLast) {
      leaveOpen(stage, predicted);
      break;
    }
  }
  scatterMotion<W>(ids_, lanes_, topology_->moves, bodies_, stage.moved);
}

template <int W>
void JointPack<W>::prepareVelocities(const JointStage& stage) {
  const JointKernels<W>& kernels = jointKernels<W>();
  bool changed[W];
  kernels.keepCarrying(view(), changed);
  for (int l = 0; l < W; ++l) stale_[l] = stale_[l] || changed[l];
  for (const int i : topology_->others) {
    for (int l = 0; l < W; ++l) {
      const bool free = l < lanes_ && states_[i].active[l] && !givesWay(i, l);
      setFree(i, l, free && (!isBounded(rows_[i], l) || !read(rows_[i].lambda, l).isZero(0)));
    }
  }
  gatherPoses<W>(ids_, stage.pose, bodies_);
  gatherMasses<W>(ids_, stage.masses, bodies_);
  kernels.seeGaps(view(), false);
  kernels.seeLimits(view(), false);
  seeOthers(stage, false, false);
  kernels.findChanged(view(), changed);
  // Where rows repeat each other, what they share is another thing after the smallest turn; and of
  // what contacts see of joints, a part in ten of the error is more than all of a light body's.
  for (int l = 0; l < W; ++l) {
    const bool isExact = !topology_->isTree || of_[l]->response_.size() > 0;
    stale_[l] = stale_[l] || changed[l] || isExact;
  }
  seenSince_ = true;
  exact_ = stale_;
  factorizeStale();
  kernels.respond(view());
}

template <int W>
void JointPack<W>::solveVelocities(const JointStage& stage) {
  openAll();
  solveOpenVelocities(stage);
}

template <int W>
void JointPack<W>::solveVelocities(const LaneBodies& lanes, std::span<const double> wanted) {
  open(wanted);
  if (isNoneOpen()) return;
  const JointContacts contacts = contactsOf(lanes);
  jointKernels<W>().takeContacts(view(), contacts);
  solveOpenVelocities();
  jointKernels<W>().tellContacts(view(), contacts);
}

template <int W>
void JointPack<W>::refineVelocities(const JointStage& stage) {
  for (int l = 0; l < W; ++l) open_.v[l] = l < lanes_ && !exact_[l] ? 1 : 0;
  solveOpenVelocities(stage);
}

template <int W>
void JointPack<W>::solveOpenVelocities(const JointStage& stage) {
  if (isNoneOpen()) return;
  gatherMotion<W>(ids_, stage.moved, bodies_);
  solveOpenVelocities();
  scatterMotion<W>(ids_, lanes_, topology_->moves, bodies_, stage.moved);
}

template <int W>
void JointPack<W>::solveOpenVelocities() {
  const JointKernels<W>& kernels = jointKernels<W>();
  for (int round = 1;; ++round) {
    factorizeStale();
    kernels.aimAtVelocities(view());
    kernels.substitute(view());
    if (round == kMostRounds || !holdAtBounds()) break;
  }
  kernels.apply(view());
}

template <int W>
bool JointPack<W>::holdsBothWays(int l) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (topology_->shapes[i].isGap) continue;
    if (topology_->shapes[i].seen != JointSeen::kByKind) return false;
    if (!states_[i].active[l]) continue;
    if (states_[i].role[l] != JointRow::Role::kConstraint || isBounded(rows_[i], l)) return false;
  }
  return true;
}

template <int W>
bool JointPack<W>::hasForce(int l) const {
  return std::any_of(topology_->others.begin(), topology_->others.end(), [&](int i) {
    return states_[i].active[l] && states_[i].role[l] == JointRow::Role::kForce;
  });
}

template <int W>
void JointPack<W>::addRows(std::vector<SharedRow>& rows) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const JointShape& shape = topology_->shapes[i];
    const JointLanes<W>& row = rows_[i];
    for (int l = 0; l < lanes_; ++l) {
      SharedRow& of = rows.emplace_back();
      for (int b = 0; b < shape.bodyCount; ++b) {
        if (!shape.moves[b]) continue;
        of.bodies[b] = ids_[shape.body[b] * W + l];
        if (shape.isGap) {
          of.linear[b] = (b == 0 ? 1 : -1) * Mat3::Identity();
          of.angular[b] = skew(read(row.angular[b], l));
        } else {
          if (shape.hasLinear) of.linear[b] = readRows(row.linear[b], l, shape.rows);
          if (shape.hasAngular) of.angular[b] = readRows(row.angular[b], l, shape.rows);
        }
      }
      if (!(row.free.v[l] > 0)) continue;
      of.rows = shape.rows;
      for (int r = 0; r < shape.rows; ++r) {
        for (int c = 0; c <= r; ++c) {
          of.alpha(r, c) = of.alpha(c, r) = row.alpha[r * (r + 1) / 2 + c].v[l];
        }
      }
    }
  }
}

template <int W>
void JointPack<W>::finish(Kinds& kinds, double h) {
  for (int l = 0; l < lanes_; ++l) {
    of_[l]->holdsBothWays_ = holdsBothWays(l);
    of_[l]->givesWay_ = hasForce(l);
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const JointLanes<W>& row = rows_[i];
    for (int l = 0; l < lanes_; ++l) {
      if (of_[l]->isOpened_) continue;
      const Vec3 lambda = read(row.lambda, l);
      writeMultiplier(kinds, of_[l]->refs_[i], lambda, h);
      Articulation::Pull& pull = of_[l]->pulls_[i];
      pull.lambda = lambda;
      if (!topology_->shapes[i].pulls) continue;
      const JointShape& shape = topology_->shapes[i];
      for (int b = 0; b < shape.bodyCount; ++b) {
        pull.arm[b] = read(row.arm[b], l);
        for (int r = 0; shape.hasLinear && r < shape.rows; ++r) {
          pull.linear[b].row(r) = read(row.linear[b] + 3 * r, l);
        }
      }
    }
  }
}

template class JointPack<1>;
template class JointPack<4>;
template class JointPack<8>;

}  // namespace physics
