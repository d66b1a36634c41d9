// Newton's method for the normal loads of contacts.
#include "physics/solver/contact_newton.h"

#include <algorithm>
#include <cmath>

#include "physics/base/inverse.h"

namespace physics {
namespace {

// Of what its bodies resist, how far a point gives way that gives way to nothing.
constexpr double kGives = 1e-6;
// Of a way that is looked along: as many halvings leave a part of 1e-12.
constexpr int kMostSlopes = 40;

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

Eigen::Matrix<double, 6, 1> sixOf(const Vec3& u, const Vec3& turn) {
  Eigen::Matrix<double, 6, 1> of;
  of << u, turn;
  return of;
}

}  // namespace

ContactNewton::Pair ContactNewton::pairOf(int slotA, int slotB) {
  Pair pair{slotA, slotB};
  const int a = places_[slotA], b = places_[slotB];
  if (a < 0 || b < 0) return pair;
  pair.entry = static_cast<int>(entries_.size());
  entries_.push_back({std::max(a, b), std::min(a, b)});
  return pair;
}

void ContactNewton::layOut(std::span<const ContactBlock> blocks, std::span<const LaneMass> masses) {
  places_.assign(masses.size(), -1);
  inverse_.assign(masses.size(), 0);
  std::swap(entries_, entriesBefore_);
  entries_.clear();
  int count = 0;
  for (std::size_t s = 1; s < masses.size(); ++s) {
    if (!(masses[s].inverse > 0)) continue;
    inverse_[s] = masses[s].inverse;
    places_[s] = count++;
    entries_.push_back({places_[s], places_[s]});
  }
  pressed_.inPositions.clear();
  pressed_.inVelocities.clear();
  contacts_.clear();
  joined_.clear();
  forEachLane(blocks, [&](const ContactBlock& block, int l) {
    contacts_.push_back(pairOf(block.bodyA[l], block.bodyB[l]));
  });
  for (const Joint& joint : joints) joined_.push_back(pairOf(joint.a, joint.b));
  if (entries_ != entriesBefore_) factor_.layOut(entries_);
  for (Motions* of : {&before_, &x_, &next_}) of->resize(masses.size());
  for (Motions* of : {&pulls_, &solved_}) of->resize(count);
}

double ContactNewton::multiplications() const { return 216 * factor_.size() * factor_.fill(); }

// lawOf(block, lane, point) of each.
template <class LawOf>
void ContactNewton::takeRows(std::span<ContactBlock> blocks, LawOf&& lawOf) {
  rows_.clear();
  int contact = 0;
  forEachLane(blocks, [&](ContactBlock& block, int l) {
    const Vec3 n = laneOf(block.n, l);
    for (int i = 0; i < block.points; ++i) {
      ContactBlock::Point& p = block.point[i];
      if (!(p.inverse[l] > 0)) continue;
      const Law law = lawOf(block, l, i);
      const double before = p.lambda[l], given = law.isHard ? before / law.stiffness : 0;
      rows_.push_back({contact, sixOf(n, laneOf(p.wA, l)).transpose(),
                       -sixOf(n, laneOf(p.wB, l)).transpose(), law.aim - given, law.stiffness,
                       before, 0, &p.lambda[l], false});
    }
    ++contact;
  });
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
  solve(motions, pressed_.inPositions, kMostSteps);
}

void ContactNewton::solveVelocities(std::span<ContactBlock> blocks, std::span<LaneMotion> motions,
                                    int mostSteps) {
  contactKernels().measure(blocks.data(), static_cast<int>(blocks.size()), motions.data());
  takeRows(blocks, [&](const ContactBlock& block, int l, int i) {
    const ContactBlock::Point& p = block.point[i];
    return Law{p.open[l], p.inverse[l] / kGives, true};
  });
  solve(motions, pressed_.inVelocities, mostSteps);
}

// M^-1
ContactNewton::Six ContactNewton::moved(int slot, const Six& impulse) const {
  Six by = impulse;
  by.head<3>() *= inverse_[slot];
  return by;
}

void ContactNewton::push(const Pair& pair, const Row& row, double lambda, Motions& x) const {
  if (places_[pair.a] >= 0) x[pair.a] += lambda * moved(pair.a, row.ofA.transpose());
  if (places_[pair.b] >= 0) x[pair.b] += lambda * moved(pair.b, row.ofB.transpose());
}

double ContactNewton::rateOf(const Row& row, const Motions& x) const {
  const Pair& pair = contacts_[row.contact];
  return row.ofA.dot(x[pair.a]) + row.ofB.dot(x[pair.b]);
}

Vec3 ContactNewton::rateOf(const Joint& joint, const Motions& x) const {
  return joint.ofA * x[joint.a] + joint.ofB * x[joint.b];
}

// What rateOf comes to where nothing cancels.
double ContactNewton::wayOf(const Row& row, const Motions& x) const {
  const Pair& pair = contacts_[row.contact];
  return row.ofA.cwiseAbs().dot(x[pair.a].cwiseAbs()) +
         row.ofB.cwiseAbs().dot(x[pair.b].cwiseAbs());
}

// From what bodies move by to what they do but for these loads, and from there on: aims count what
// they move by without. What falls with what it lies on presses as well as what lies on the floor:
// from one to the next it would take a step for each.
void ContactNewton::start(std::span<const LaneMotion> motions) {
  std::fill(before_.begin(), before_.end(), Six::Zero());
  x_[0].setZero();
  for (std::size_t s = 1; s < motions.size(); ++s) {
    x_[s] = sixOf(vectorOf(motions[s].u), vectorOf(motions[s].turn));
  }
  for (const Row& row : rows_) push(contacts_[row.contact], row, row.before, before_);
  for (Row& row : rows_) {
    const double rate = rateOf(row, x_);
    row.presses = row.before > 0 || rate + row.aim < kGives * wayOf(row, x_);
    row.aim += rate - rateOf(row, before_);
  }
  x_ = before_;
}

// Of what their bodies resist, joints give way by as little as contacts do.
Mat3 ContactNewton::stiffnessOf(const Joint& j) const {
  Mat3 gives = j.alpha;
  const auto resists = [&](int slot, const Rows& of) {
    return inverse_[slot] * of.leftCols<3>().squaredNorm() + of.rightCols<3>().squaredNorm();
  };
  gives.diagonal().array() += kGives * (resists(j.a, j.ofA) + resists(j.b, j.ofB)) / 3;
  for (int r = j.rows; r < 3; ++r) gives(r, r) = 1;
  return inverseOrNan<Mat3>(gives);
}

// J^T k of a row or a joint, whose J is by bodies.
template <class J, class K>
void ContactNewton::add(const Pair& pair, const J& ofA, const J& ofB, const K& kA, const K& kB) {
  const auto addTo = [&](int entry, const J& left, const K& right) {
    matrixOf(factor_.value(entry)).noalias() += left.transpose().lazyProduct(right);
  };
  const int a = places_[pair.a], b = places_[pair.b];
  if (a >= 0) addTo(a, ofA, kA);
  if (b >= 0) addTo(b, ofB, kB);
  if (pair.entry < 0) return;
  // A block is its row's and its column's, the later of the two and the earlier, or turned.
  if ((a > b) != factor_.isTurned(pair.entry)) {
    addTo(pair.entry, ofA, kB);
  } else {
    addTo(pair.entry, ofB, kA);
  }
}

// What is the same in all steps of Newton's: masses and joints, in the factor's values.
void ContactNewton::holdJoints() {
  held_.resize(joints.size());
  factor_.begin();
  std::fill(pulls_.begin(), pulls_.end(), Six::Zero());
  for (std::size_t s = 1; s < places_.size(); ++s) {
    if (places_[s] < 0) continue;
    auto own = matrixOf(factor_.value(places_[s]));
    own.diagonal().head<3>().array() += 1 / inverse_[s];
    own.diagonal().tail<3>().array() += 1;
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint& j = joints[k];
    Held& held = held_[k];
    held = {j.rows > 0 ? stiffnessOf(j) : Mat3::Zero().eval(), rateOf(j, before_)};
    const Rows kA = held.stiffness * j.ofA, kB = held.stiffness * j.ofB;
    add(joined_[k], j.ofA, j.ofB, kA, kB);
    if (const int a = places_[j.a]; a >= 0) pulls_[a].noalias() += kA.transpose() * held.start;
    if (const int b = places_[j.b]; b >= 0) pulls_[b].noalias() += kB.transpose() * held.start;
  }
  factor_.keep();
}

// What presses at x. True: the same as before.
bool ContactNewton::markPressing(const Motions& x) {
  bool same = true;
  for (Row& row : rows_) {
    const bool presses = rateOf(row, x) + row.aim < 0;
    same = same && presses == row.presses;
    row.presses = presses;
  }
  return same;
}

// Where x were least if what presses went on to, and nothing else.
void ContactNewton::minimize(Motions& x) {
  factor_.takeKept();
  solved_ = pulls_;
  for (const Row& row : rows_) {
    if (!row.presses) continue;
    const Pair& pair = contacts_[row.contact];
    const RowSix kA = row.stiffness * row.ofA, kB = row.stiffness * row.ofB;
    add(pair, row.ofA, row.ofB, kA, kB);
    if (const int a = places_[pair.a]; a >= 0) solved_[a] -= row.aim * kA.transpose();
    if (const int b = places_[pair.b]; b >= 0) solved_[b] -= row.aim * kB.transpose();
  }
  factor_.factorize();
  factor_.solve(std::span(solved_));
  for (std::size_t s = 1; s < x.size(); ++s) {
    if (places_[s] >= 0) x[s] = solved_[places_[s]];
  }
}

// How far along the way from x to next_ it is least: where the slope, which rises piece by piece in
// straight lines, is nothing.
double ContactNewton::findLeast() {
  double slope0 = 0, rise = 0;
  for (std::size_t s = 1; s < x_.size(); ++s) {
    if (places_[s] < 0) continue;
    Six pull = next_[s] - x_[s];
    const Six way = pull;
    pull.head<3>() /= inverse_[s];
    slope0 += x_[s].dot(pull);
    rise += way.dot(pull);
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Vec3 from = rateOf(joints[k], x_), change = rateOf(joints[k], next_) - from;
    const Vec3 pull = held_[k].stiffness * change;
    slope0 += pull.dot(from - held_[k].start);
    rise += pull.dot(change);
  }
  along_.clear();
  for (const Row& row : rows_) {
    const double from = rateOf(row, x_) + row.aim;
    along_.push_back({from, rateOf(row, next_) + row.aim - from, row.stiffness});
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

// By how much f of the sweeps, and what springs hold, is less for x and its loads than for those of
// before.
double ContactNewton::gainOf(const Motions& x) const {
  double rise = 0;
  for (const Row& row : rows_) {
    const double more = row.lambda - row.before, from = rateOf(row, before_);
    rise += more * (row.aim + 0.5 * (from + rateOf(row, x)) +
                    0.5 * (row.lambda + row.before) / row.stiffness);
  }
  return -rise;
}

// Of what is looked for the least, at x.
double ContactNewton::valueOf(const Motions& x) const {
  double sum = 0;
  for (std::size_t s = 1; s < x.size(); ++s) {
    if (places_[s] < 0) continue;
    sum += x[s].head<3>().squaredNorm() / inverse_[s] + x[s].tail<3>().squaredNorm();
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Vec3 open = rateOf(joints[k], x) - held_[k].start;
    sum += open.dot(held_[k].stiffness * open);
  }
  for (const Row& row : rows_) {
    const double depth = std::min(rateOf(row, x) + row.aim, 0.0);
    sum += row.stiffness * depth * depth;
  }
  return 0.5 * sum;
}

// From what is thought to press, to next_. True: the same points press there, and it is least.
bool ContactNewton::descend(int mostSteps) {
  for (int k = 0; k < mostSteps; ++k) {
    next_ = x_;
    minimize(next_);
    if (markPressing(next_)) return true;
    if (valueOf(next_) < valueOf(x_)) {
      std::swap(x_, next_);
      continue;
    }
    const double t = findLeast();
    for (std::size_t s = 1; s < x_.size(); ++s) x_[s] += t * (next_[s] - x_[s]);
    markPressing(x_);
  }
  next_ = x_;
  return false;
}

// Loads that do not go down are not taken.
void ContactNewton::solve(std::span<LaneMotion> motions, std::vector<char>& pressed,
                          int mostSteps) {
  start(motions);
  if (pressed.size() == rows_.size()) {
    for (std::size_t k = 0; k < rows_.size(); ++k) rows_[k].presses = pressed[k] != 0;
  }
  holdJoints();
  const bool ends = descend(mostSteps);
  pressed.clear();
  for (const Row& row : rows_) pressed.push_back(row.presses);
  std::fill(x_.begin(), x_.end(), Six::Zero());
  for (Row& row : rows_) {
    row.lambda = row.stiffness * std::max(-(rateOf(row, next_) + row.aim), 0.0);
    push(contacts_[row.contact], row, row.lambda, x_);
  }
  if (!joints.empty() && !ends) return;
  if (!(gainOf(joints.empty() ? x_ : next_) > 0)) return;
  for (const Row& row : rows_) *row.stored = static_cast<float>(row.lambda);
  for (std::size_t s = 1; s < motions.size(); ++s) {
    for (int k = 0; k < 3; ++k) {
      motions[s].u[k] += static_cast<float>(x_[s][k] - before_[s][k]);
      motions[s].turn[k] += static_cast<float>(x_[s][3 + k] - before_[s][3 + k]);
    }
  }
}

}  // namespace physics
