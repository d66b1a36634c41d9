// Newton's method for the normal loads of contacts.
#include "physics/solver/contact_newton.h"

#include <algorithm>
#include <cmath>

#include "physics/base/inverse.h"

namespace physics {
namespace {

// Of what its bodies resist, how far a point gives way that gives way to nothing.
constexpr double kGives = 1e-6;
// Which points press changes from step to step; what does not end is not taken.
constexpr int kMostNewtonSteps = 32, kMostSlopes = 40;

Vec3 laneOf(const float (&v)[3][8], int l) { return {v[0][l], v[1][l], v[2][l]}; }
Vec3 vectorOf(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

template <class Block, class F>
void forEachLane(std::span<Block> blocks, F&& f) {
  for (Block& block : blocks) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] >= 0) f(block, l);
    }
  }
}

template <class C, class X>
double rateOf(const C& c, const auto& row, const X& x) {
  return row.n.dot(x[c.a].u - x[c.b].u) + row.wA.dot(x[c.a].turn) - row.wB.dot(x[c.b].turn);
}

template <class X>
Vec3 rateOf(const ContactNewton::Joint& j, const X& x) {
  return j.linearA * x[j.a].u + j.turnA * x[j.a].turn + j.linearB * x[j.b].u +
         j.turnB * x[j.b].turn;
}

}  // namespace

void ContactNewton::layOut(std::span<const ContactBlock> blocks, std::span<const LaneMass> masses) {
  places_.assign(masses.size(), -1);
  inverse_.assign(masses.size(), 0);
  std::swap(entries_, entriesBefore_);
  entries_.clear();
  int count = 0;
  for (std::size_t s = 1; s < masses.size(); ++s) {
    if (!(masses[s].inverse > 0)) continue;
    inverse_[s] = masses[s].inverse;
    const int u = places_[s] = count, turn = u + 1;
    entries_.insert(entries_.end(), {{u, u}, {turn, u}, {turn, turn}});
    count += 2;
  }
  const auto addPair = [&](int slotA, int slotB) {
    const int a = places_[slotA], b = places_[slotB];
    if (a < 0 || b < 0) return;
    const auto [low, high] = std::minmax(a, b);
    for (const int row : {high, high + 1}) {
      for (const int column : {low, low + 1}) entries_.push_back({row, column});
    }
  };
  forEachLane(blocks,
              [&](const ContactBlock& block, int l) { addPair(block.bodyA[l], block.bodyB[l]); });
  for (const Joint& joint : joints) addPair(joint.a, joint.b);
  if (entries_ != entriesBefore_) factor_.layOut(entries_);
  own_.resize(masses.size());
  for (Motions* of : {&before_, &x_, &next_}) of->resize(masses.size());
  solved_.resize(count);
}

// lawOf(block, lane, point) of each.
template <class LawOf>
void ContactNewton::takeRows(std::span<ContactBlock> blocks, LawOf&& lawOf) {
  contacts_.clear();
  rows_.clear();
  forEachLane(blocks, [&](ContactBlock& block, int l) {
    contacts_.push_back({block.bodyA[l], block.bodyB[l], rows_.size(), 0});
    for (int i = 0; i < block.points; ++i) {
      ContactBlock::Point& p = block.point[i];
      if (!(p.inverse[l] > 0)) continue;
      const Law law = lawOf(block, l, i);
      const double before = p.lambda[l], given = law.isHard ? before / law.stiffness : 0;
      rows_.push_back({laneOf(block.n, l), laneOf(p.wA, l), laneOf(p.wB, l), law.aim - given,
                       law.stiffness, before, 0, &p.lambda[l], false});
    }
    contacts_.back().end = rows_.size();
  });
  between_.resize(contacts_.size());
}

void ContactNewton::solvePositions(std::span<ContactBlock> blocks, std::span<LaneMotion> motions,
                                   PositionSweep which) {
  aims_.resize(blocks.size());
  contactKernels().findAims(blocks.data(), static_cast<int>(blocks.size()), motions.data(), which,
                            aims_.data());
  takeRows(blocks, [&](const ContactBlock& block, int l, int i) {
    const PositionAims& of = aims_[&block - blocks.data()];
    const double scale = of.scale[i][l], gives = std::max(1 - scale, kGives);
    return Law{of.aim[i][l] / scale, block.point[i].inverse[l] * scale / gives, scale == 1};
  });
  solve(motions);
}

void ContactNewton::solveVelocities(std::span<ContactBlock> blocks, std::span<LaneMotion> motions) {
  contactKernels().measure(blocks.data(), static_cast<int>(blocks.size()), motions.data());
  takeRows(blocks, [&](const ContactBlock& block, int l, int i) {
    const ContactBlock::Point& p = block.point[i];
    return Law{p.open[l], p.inverse[l] / kGives, true};
  });
  solve(motions);
}

void ContactNewton::push(const Contact& c, const Row& row, double lambda, Motions& x) const {
  if (places_[c.a] >= 0) {
    x[c.a].u += inverse_[c.a] * lambda * row.n;
    x[c.a].turn += lambda * row.wA;
  }
  if (places_[c.b] >= 0) {
    x[c.b].u -= inverse_[c.b] * lambda * row.n;
    x[c.b].turn -= lambda * row.wB;
  }
}

// From what bodies move by to what they do but for these loads, and from there on: aims count what
// they move by without.
void ContactNewton::start(std::span<const LaneMotion> motions) {
  std::fill(before_.begin(), before_.end(), Motion{});
  for (std::size_t s = 1; s < motions.size(); ++s) {
    x_[s] = {vectorOf(motions[s].u), vectorOf(motions[s].turn)};
  }
  x_[0] = {};
  for (const Contact& c : contacts_) {
    for (std::size_t i = c.first; i < c.end; ++i) push(c, rows_[i], rows_[i].before, before_);
  }
  for (const Contact& c : contacts_) {
    for (std::size_t i = c.first; i < c.end; ++i) {
      Row& row = rows_[i];
      const double rate = rateOf(c, row, x_);
      row.presses = row.before > 0 || rate + row.aim < 0;
      row.aim += rate - rateOf(c, row, before_);
    }
  }
  x_ = before_;
}

// Of what their bodies resist, joints give way by as little as contacts do.
Mat3 ContactNewton::stiffnessOf(const Joint& j) const {
  Mat3 gives = j.alpha;
  const double resists = inverse_[j.a] * j.linearA.squaredNorm() + j.turnA.squaredNorm() +
                         inverse_[j.b] * j.linearB.squaredNorm() + j.turnB.squaredNorm();
  gives.diagonal().array() += kGives * resists / 3;
  for (int r = j.rows; r < 3; ++r) gives(r, r) = 1;
  return inverseOrNan<Mat3>(gives);
}

// By the rows of a joint for one of its bodies, and these times the joint's stiffness.
ContactNewton::Share ContactNewton::shareOf(const Mat3& linear, const Mat3& turn,
                                            const Mat3& kLinear, const Mat3& kTurn,
                                            const Vec3& start) {
  return {linear.transpose() * kLinear, turn.transpose() * kLinear, turn.transpose() * kTurn,
          kLinear.transpose() * start, kTurn.transpose() * start};
}

// What is the same in all steps of Newton's.
void ContactNewton::holdJoints() {
  held_.resize(joints.size());
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint& j = joints[k];
    Held& held = held_[k];
    held.stiffness = j.rows > 0 ? stiffnessOf(j) : Mat3::Zero().eval();
    held.start = rateOf(j, before_);
    const Mat3 kLinearOfA = held.stiffness * j.linearA, kTurnOfA = held.stiffness * j.turnA;
    const Mat3 kLinearOfB = held.stiffness * j.linearB, kTurnOfB = held.stiffness * j.turnB;
    held.a = shareOf(j.linearA, j.turnA, kLinearOfA, kTurnOfA, held.start);
    held.b = shareOf(j.linearB, j.turnB, kLinearOfB, kTurnOfB, held.start);
    held.between.u.noalias() = j.linearA.transpose() * kLinearOfB;
    held.between.uTurn.noalias() = j.linearA.transpose() * kTurnOfB;
    held.between.turnU.noalias() = j.turnA.transpose() * kLinearOfB;
    held.between.turn.noalias() = j.turnA.transpose() * kTurnOfB;
  }
}

// What presses at x. True: the same as before.
bool ContactNewton::markPressing() {
  bool same = true;
  for (const Contact& c : contacts_) {
    for (std::size_t i = c.first; i < c.end; ++i) {
      const bool presses = rateOf(c, rows_[i], x_) + rows_[i].aim < 0;
      same = same && presses == rows_[i].presses;
      rows_[i].presses = presses;
    }
  }
  return same;
}

// Sums over the points of a contact, which have one normal.
void ContactNewton::addContact(const Contact& c, Block& between) {
  double k = 0, aim = 0;
  Vec3 wA = Vec3::Zero(), wB = wA, aimA = wA, aimB = wA;
  Mat3 turnA = Mat3::Zero(), turnB = turnA;
  between.turn.setZero();
  for (std::size_t i = c.first; i < c.end; ++i) {
    const Row& row = rows_[i];
    if (!row.presses) continue;
    const Vec3 kA = row.stiffness * row.wA, kB = row.stiffness * row.wB;
    k += row.stiffness;
    aim += row.stiffness * row.aim;
    wA += kA;
    wB += kB;
    aimA += row.aim * kA;
    aimB += row.aim * kB;
    turnA.noalias() += kA * row.wA.transpose();
    turnB.noalias() += kB * row.wB.transpose();
    between.turn.noalias() -= kA * row.wB.transpose();
  }
  const Vec3 n = c.first < c.end ? rows_[c.first].n : Vec3::Zero();
  const Mat3 alongNormal = k * n * n.transpose();
  between.u = -alongNormal;
  between.uTurn.noalias() = -n * wB.transpose();
  between.turnU.noalias() = -wA * n.transpose();
  const auto addOwn = [&](int slot, const Vec3& w, const Mat3& turn, double sign,
                          const Vec3& aims) {
    const int place = places_[slot];
    if (place < 0) return;
    own_[slot].u += alongNormal;
    own_[slot].turnU.noalias() += w * n.transpose();
    own_[slot].turn += turn;
    solved_[place] -= sign * aim * n;
    solved_[place + 1] -= sign * aims;
  };
  addOwn(c.a, wA, turnA, 1, aimA);
  addOwn(c.b, wB, turnB, -1, aimB);
}

void ContactNewton::addShare(int slot, const Share& share) {
  const int place = places_[slot];
  if (place < 0) return;
  own_[slot].u += share.u;
  own_[slot].turnU += share.turnU;
  own_[slot].turn += share.turn;
  solved_[place] += share.pull;
  solved_[place + 1] += share.pullTurn;
}

void ContactNewton::giveBetween(int slotA, int slotB, const Block& of) {
  const int a = places_[slotA], b = places_[slotB];
  if (a < 0 || b < 0) return;
  const bool isTurned = a < b;
  factor_.give(of.u);
  factor_.give(isTurned ? of.turnU.transpose() : of.uTurn);
  factor_.give(isTurned ? of.uTurn.transpose() : of.turnU);
  factor_.give(isTurned ? of.turn.transpose() : of.turn);
}

// In the order of the entries.
void ContactNewton::giveMatrix() {
  factor_.begin();
  for (std::size_t s = 1; s < own_.size(); ++s) {
    if (places_[s] < 0) continue;
    factor_.give(own_[s].u);
    factor_.give(own_[s].turnU);
    factor_.give(own_[s].turn);
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    giveBetween(contacts_[k].a, contacts_[k].b, between_[k]);
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    giveBetween(joints[k].a, joints[k].b, held_[k].between);
  }
}

// Where x were least if what presses went on to, and nothing else.
void ContactNewton::minimize(Motions& x) {
  const Mat3 zero = Mat3::Zero(), one = Mat3::Identity();
  std::fill(solved_.begin(), solved_.end(), Vec3::Zero());
  for (std::size_t s = 1; s < own_.size(); ++s) {
    if (places_[s] >= 0) own_[s] = {one / inverse_[s], zero, zero, one};
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k) addContact(contacts_[k], between_[k]);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    addShare(joints[k].a, held_[k].a);
    addShare(joints[k].b, held_[k].b);
  }
  giveMatrix();
  factor_.factorize();
  factor_.solve(solved_);
  for (std::size_t s = 1; s < x.size(); ++s) {
    if (const int place = places_[s]; place >= 0) x[s] = {solved_[place], solved_[place + 1]};
  }
}

// How far along the way from x to next_ it is least: where the slope, which rises piece by piece in
// straight lines, is nothing.
double ContactNewton::findLeast() {
  double slope0 = 0, rise = 0;
  for (std::size_t s = 1; s < x_.size(); ++s) {
    if (places_[s] < 0) continue;
    const Vec3 u = next_[s].u - x_[s].u, turn = next_[s].turn - x_[s].turn;
    slope0 += x_[s].u.dot(u) / inverse_[s] + x_[s].turn.dot(turn);
    rise += u.squaredNorm() / inverse_[s] + turn.squaredNorm();
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Vec3 from = rateOf(joints[k], x_), change = rateOf(joints[k], next_) - from;
    const Vec3 pull = held_[k].stiffness * change;
    slope0 += pull.dot(from - held_[k].start);
    rise += pull.dot(change);
  }
  along_.clear();
  for (const Contact& c : contacts_) {
    for (std::size_t i = c.first; i < c.end; ++i) {
      const double from = rateOf(c, rows_[i], x_) + rows_[i].aim;
      along_.push_back(
          {from, rateOf(c, rows_[i], next_) + rows_[i].aim - from, rows_[i].stiffness});
    }
  }
  double low = 0, high = 1, t = 1;
  for (int k = 0; k < kMostSlopes; ++k) {
    double slope = slope0 + t * rise, steeper = rise;
    for (const Along& of : along_) {
      const double depth = of.from + t * of.change;
      if (depth >= 0) continue;
      slope += of.stiffness * of.change * depth;
      steeper += of.stiffness * of.change * of.change;
    }
    if (std::abs(slope) <= 1e-9 * steeper) break;
    (slope > 0 ? high : low) = t;
    if (slope < 0 && t == 1) break;
    t -= slope / steeper;
    if (!(t > low && t < high)) t = 0.5 * (low + high);
  }
  return t;
}

// A step from x, as far as it goes down.
void ContactNewton::descend() {
  next_ = x_;
  minimize(next_);
  const double t = findLeast();
  for (std::size_t s = 1; s < x_.size(); ++s) {
    x_[s].u += t * (next_[s].u - x_[s].u);
    x_[s].turn += t * (next_[s].turn - x_[s].turn);
  }
}

// By how much f of the sweeps, and what springs hold, is less for x and its loads than for those of
// before.
double ContactNewton::gainOf(const Motions& x) const {
  double rise = 0;
  for (const Contact& c : contacts_) {
    for (std::size_t i = c.first; i < c.end; ++i) {
      const Row& row = rows_[i];
      const double more = row.lambda - row.before, from = rateOf(c, row, before_);
      rise += more * (row.aim + 0.5 * (from + rateOf(c, row, x)) +
                      0.5 * (row.lambda + row.before) / row.stiffness);
    }
  }
  return -rise;
}

// Loads that do not go down are not taken.
void ContactNewton::solve(std::span<LaneMotion> motions) {
  start(motions);
  holdJoints();
  bool ends = false;
  for (int k = 0; k < kMostNewtonSteps && !ends; ++k) {
    descend();
    ends = markPressing();
  }
  std::swap(x_, next_);
  std::fill(x_.begin(), x_.end(), Motion{});
  for (const Contact& c : contacts_) {
    for (std::size_t i = c.first; i < c.end; ++i) {
      Row& row = rows_[i];
      row.lambda = row.stiffness * std::max(-(rateOf(c, row, next_) + row.aim), 0.0);
      push(c, row, row.lambda, x_);
    }
  }
  if (!joints.empty() && !ends) return;
  if (!(gainOf(joints.empty() ? x_ : next_) > 0)) return;
  for (const Row& row : rows_) *row.stored = static_cast<float>(row.lambda);
  for (std::size_t s = 1; s < motions.size(); ++s) {
    for (int k = 0; k < 3; ++k) {
      motions[s].u[k] += static_cast<float>(x_[s].u[k] - before_[s].u[k]);
      motions[s].turn[k] += static_cast<float>(x_[s].turn[k] - before_[s].turn[k]);
    }
  }
}

}  // namespace physics
