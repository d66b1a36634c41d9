// Articulations into the lanes of turns, and back.
#include "physics/solver/turn_pack.h"

#include <algorithm>
#include <array>

#include "physics/solver/articulation.h"
#include "physics/solver/joint_lanes.h"

namespace physics {
namespace {

constexpr int kGapNumbers = sizeof(TurnGap) / sizeof(Eight);

constexpr int triangleOf(int r, int c) { return r > c ? r * (r + 1) / 2 + c : c * (c + 1) / 2 + r; }

template <int W>
void put(const Num<W>* from, int count, int lane, Eight* to) {
  for (int k = 0; k < count; ++k) {
    for (int l = 0; l < W; ++l) to[k].v[lane + l] = static_cast<float>(from[k].v[l]);
  }
}

template <int W>
void putZero(int count, int lane, Eight* to) {
  for (int k = 0; k < count; ++k) std::fill_n(to[k].v + lane, W, 0.f);
}

// Of lanes without an articulation nothing is free.
template <int W>
void putFree(const Num<W>& free, int lanes, int lane, Eight& to) {
  for (int l = 0; l < W; ++l) to.v[lane + l] = l < lanes && free.v[l] > 0 ? 1.f : 0.f;
}

// The part of a rate that is known before a turn, of a body: what it moved by where its rows were
// seen, from which those of positions count; or what it moves by where it is not moved.
template <int W>
struct Known {
  double sign = 0;  // 0: nothing is
  const Num<W>*u = nullptr, *theta = nullptr;
};

template <int W>
Known<W> knownOf(const JointBody<W>& body, bool moves, TurnStage stage) {
  const bool positions = stage == TurnStage::kPositions;
  if (moves != positions) return {};
  return positions ? Known<W>{-1, body.seenU, body.seenTheta} : Known<W>{1, body.u, body.theta};
}

// Those that are marked, and the place of each among them; -1: it is not.
template <class Marks>
void choose(const Marks& marks, std::vector<int>& chosen, std::vector<int>& placeOf) {
  chosen.clear();
  placeOf.assign(marks.size(), -1);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (!marks[i]) continue;
    placeOf[i] = static_cast<int>(chosen.size());
    chosen.push_back(static_cast<int>(i));
  }
}

}  // namespace

bool TurnPack::serves(const JointTopology& t) {
  return t.isTree && t.others.empty() && t.bounded.empty();
}

void TurnPack::layOut(const JointTopology& t) {
  choose(t.moves, movers_, moverOf_);
  choose(usedLimits_, limits_, limitOf_);
  rows_.clear();
  below_.clear();
  int numbers = 0;
  for (int i = 0; i < t.tailStart; ++i) {
    layOutRow(t, i, numbers);
    numbers += kGapNumbers;
    const TurnRow& row = rows_.back();
    for (int k = 0; k < row.belowCount; ++k) {
      numbers += below_[row.below + k] < 3 * t.tailStart ? 9 : 3;
    }
  }
  for (const int k : limits_) layOutRow(t, t.tailStart + k, 0);
  const std::size_t n = limits_.size(), triangle = n * (n + 1) / 2, sides = 3 * t.tailStart + n;
  numbers_.resize(numbers);
  right_.resize(sides);
  lambda_.resize(sides);
  tail_.resize(triangle);
  factor_.resize(triangle);
  held_.resize(2 * n);
  limitNumbers_.resize(n);
  gives_.resize(n);
  bodies_.resize(movers_.size());
  motions_.resize(movers_.size());
}

// Row i of the topology, with the rows below that there are.
void TurnPack::layOutRow(const JointTopology& t, int i, int numbers) {
  const JointShape& shape = t.shapes[i];
  TurnRow& row = rows_.emplace_back();
  for (int b = 0; b < 2; ++b) row.body[b] = shape.moves[b] ? moverOf_[shape.body[b]] : -1;
  row.numbers = numbers;
  row.below = static_cast<int>(below_.size());
  for (int k = 0; i < t.tailStart && k < t.columns[i].count; ++k) {
    const int to = t.below[t.columns[i].start + k].to;
    if (to < t.tailStart) {
      below_.push_back(3 * to);
    } else if (const int limit = limitOf_[to - t.tailStart]; limit >= 0) {
      below_.push_back(3 * t.tailStart + limit);
    }
  }
  row.belowCount = static_cast<int>(below_.size()) - row.below;
}

// Lanes that nothing is copied to.
void TurnPack::clear() {
  std::fill(bodies_.begin(), bodies_.end(), TurnBody{});
  std::fill(limitNumbers_.begin(), limitNumbers_.end(), TurnLimit{});
  for (auto* numbers : {&numbers_, &lambda_, &tail_}) {
    std::fill(numbers->begin(), numbers->end(), Eight{});
  }
}

template <int W>
void TurnPack::take(std::span<JointPack<W>* const> packs, const LaneBodies& lanes,
                    TurnStage stage) {
  const JointTopology& t = *packs.front()->topology_;
  bool isNew = false;
  for (const JointPack<W>* pack : packs) isNew = isNew || pack->isNewFactor_;
  if (isNew) {
    usedLimits_.assign(t.shapes.size() - t.tailStart, 0);
    for (const JointPack<W>* pack : packs) {
      for (std::size_t k = 0; k < usedLimits_.size(); ++k) {
        usedLimits_[k] = usedLimits_[k] || pack->used_[t.tailStart + k];
      }
    }
    layOut(t);
    if (W * packs.size() < 8) clear();
  }
  for (int k = 0; k < static_cast<int>(packs.size()); ++k) {
    if (isNew) fillFactor(*packs[k], k * W);
    fillRows(*packs[k], k * W, lanes, stage);
    packs[k]->isNewFactor_ = false;
  }
  isFactored_ = false;
}

template <int W>
void TurnPack::fillFactor(const JointPack<W>& pack, int lane) {
  const JointTopology& t = *pack.topology_;
  const auto copy = [lane](bool isUsed, const Num<W>* from, int count, Eight* to) {
    isUsed ? put(from, count, lane, to) : putZero<W>(count, lane, to);
  };
  for (int i = 0; i < t.tailStart; ++i) {
    Eight* const numbers = &numbers_[rows_[i].numbers];
    TurnGap& gap = *reinterpret_cast<TurnGap*>(numbers);
    const bool isUsed = pack.used_[i] != 0;
    copy(isUsed, pack.rows_[i].factor.inverse, 6, gap.inverse);
    Eight* block = numbers + kGapNumbers;
    for (int k = 0; k < t.columns[i].count; ++k) {
      const JointBelow& below = t.below[t.columns[i].start + k];
      if (below.to >= t.tailStart && limitOf_[below.to - t.tailStart] < 0) continue;
      const int count = 3 * t.shapes[below.to].size;
      copy(isUsed && pack.used_[below.to], pack.scaled_.data() + below.at, count, block);
      block += count;
    }
  }
  for (std::size_t k = 0; k < limits_.size(); ++k) {
    for (std::size_t j = 0; j <= k; ++j) {
      const bool both =
          pack.used_[t.tailStart + limits_[k]] && pack.used_[t.tailStart + limits_[j]];
      copy(both, pack.tail_.data() + triangleOf(limits_[k], limits_[j]), 1,
           &tail_[triangleOf(static_cast<int>(k), static_cast<int>(j))]);
    }
  }
}

template <int W>
void TurnPack::fillRows(const JointPack<W>& pack, int lane, const LaneBodies& lanes,
                        TurnStage stage) {
  const JointTopology& t = *pack.topology_;
  for (int i = 0; i < static_cast<int>(movers_.size()); ++i) fillBody(pack, i, lane, lanes);
  for (int i = 0; i < t.tailStart; ++i) fillGap(pack, i, lane, stage);
  for (int k = 0; k < static_cast<int>(limits_.size()); ++k) fillLimit(pack, k, lane, stage);
}

template <int W>
void TurnPack::fillBody(const JointPack<W>& pack, int body, int lane, const LaneBodies& lanes) {
  TurnBody& to = bodies_[body];
  const JointBody<W>& from = pack.bodies_[movers_[body]];
  for (int l = 0; l < W; ++l) {
    const bool isThere = l < pack.lanes_;
    const int slot = isThere ? lanes.slotOf[pack.ids_[movers_[body] * W + l]] : 0;
    to.slot[lane + l] = slot;
    to.inverseMass.v[lane + l] = isThere ? static_cast<float>(from.inverseMass.v[l]) : 0.f;
    for (int k = 0; k < 6; ++k) to.root[k].v[lane + l] = lanes.masses[slot].root[k];
    const auto inertia = [&](int k) { return from.inertia[k].v[l]; };
    const Vec3 columns[3] = {{inertia(0), inertia(3), inertia(4)},
                             {inertia(3), inertia(1), inertia(5)},
                             {inertia(4), inertia(5), inertia(2)}};
    for (int c = 0; c < 3; ++c) {
      const Vec3 turn = isThere ? turnOf(lanes.inverses[slot], columns[c]) : Vec3::Zero();
      for (int r = 0; r < 3; ++r) to.given[3 * r + c].v[lane + l] = static_cast<float>(turn[r]);
    }
  }
}

template <int W>
void TurnPack::fillGap(const JointPack<W>& pack, int i, int lane, TurnStage stage) {
  const JointTopology& t = *pack.topology_;
  const JointShape& shape = t.shapes[i];
  const JointLanes<W>& row = pack.rows_[i];
  const bool positions = stage == TurnStage::kPositions, isUsed = pack.used_[i] != 0;
  TurnGap& gap = *reinterpret_cast<TurnGap*>(&numbers_[rows_[i].numbers]);
  putFree(row.free, isUsed ? pack.lanes_ : 0, lane, gap.free);
  putZero<W>(1, lane, &gap.yields);
  if (positions && isUsed) put(&row.factor.yields, 1, lane, &gap.yields);
  put(row.lambda, 3, lane, &lambda_[3 * i]);
  Num<W> off[3] = {};
  for (int k = 0; positions && k < 3; ++k) {
    for (int l = 0; l < W; ++l) off[k].v[l] = row.c[k].v[l] - row.left[k].v[l];
  }
  for (int b = 0; b < 2; ++b) {
    const Num<W>* arm = row.angular[b];
    put(arm, 3, lane, gap.arm[b]);
    const Known<W> known = knownOf(pack.bodies_[shape.body[b]], shape.moves[b], stage);
    if (known.sign == 0) continue;
    const double sign = b == 0 ? known.sign : -known.sign;
    for (int k = 0; k < 3; ++k) {
      const int m = (k + 1) % 3, n = (k + 2) % 3;
      for (int l = 0; l < W; ++l) {
        off[k].v[l] += sign * known.u[k].v[l] + known.sign * (arm[m].v[l] * known.theta[n].v[l] -
                                                              arm[n].v[l] * known.theta[m].v[l]);
      }
    }
  }
  put(off, 3, lane, gap.off);
}

template <int W>
void TurnPack::fillLimit(const JointPack<W>& pack, int place, int lane, TurnStage stage) {
  const JointTopology& t = *pack.topology_;
  const int i = t.tailStart + limits_[place];
  const JointShape& shape = t.shapes[i];
  const JointLanes<W>& row = pack.rows_[i];
  const bool positions = stage == TurnStage::kPositions, isUsed = pack.used_[i] != 0;
  TurnLimit& limit = limitNumbers_[place];
  put(row.lambda, 1, lane, &lambda_[3 * t.tailStart + place]);
  putZero<W>(sizeof(TurnLimit) / sizeof(Eight), lane, &limit.free);
  if (!isUsed) return;
  putFree(row.free, pack.lanes_, lane, limit.free);
  if (positions) put(&row.factor.yields, 1, lane, &limit.yields);
  Num<W> off = {};
  for (int l = 0; positions && l < W; ++l) off.v[l] = row.c[0].v[l] - row.left[0].v[l];
  for (int b = 0; b < 2; ++b) {
    const Known<W> known = knownOf(pack.bodies_[shape.body[b]], shape.moves[b], stage);
    for (int k = 0; known.sign != 0 && k < 3; ++k) {
      for (int l = 0; l < W; ++l) {
        off.v[l] += known.sign * row.angular[b][k].v[l] * known.theta[k].v[l];
      }
    }
  }
  put(&off, 1, lane, &limit.off);
  put(row.angular[1], 3, lane, limit.gradient);
  put(&row.low, 1, lane, &limit.low);
  put(&row.high, 1, lane, &limit.high);
}

void TurnPack::follow(std::span<LaneMotion> motions) {
  const int gaps = static_cast<int>(rows_.size() - limits_.size());
  turnKernels().follow({bodies_.data(), motions_.data(), static_cast<int>(bodies_.size()),
                        rows_.data(), gaps, static_cast<int>(limits_.size()), below_.data(),
                        numbers_.data(), limitNumbers_.data(), right_.data(), lambda_.data(),
                        tail_.data(), factor_.data(), held_.data(), gives_.data(), &isFactored_},
                       motions.data());
}

template <int W>
void TurnPack::giveBack(std::span<JointPack<W>* const> packs) const {
  for (std::size_t p = 0; p < packs.size(); ++p) {
    JointPack<W>& pack = *packs[p];
    const int lane = static_cast<int>(p) * W, first = pack.topology_->tailStart;
    for (int l = 0; l < pack.lanes_; ++l) {
      for (int k = 0; k < 3 * first; ++k) {
        pack.rows_[k / 3].lambda[k % 3].v[l] = lambda_[k].v[lane + l];
      }
      for (std::size_t k = 0; k < limits_.size(); ++k) {
        JointLanes<W>& row = pack.rows_[first + limits_[k]];
        row.lambda[0].v[l] = lambda_[3 * first + k].v[lane + l];
        row.free.v[l] = limitNumbers_[k].free.v[lane + l];
      }
    }
  }
}

template void TurnPack::take(std::span<JointPack<1>* const>, const LaneBodies&, TurnStage);
template void TurnPack::take(std::span<JointPack<4>* const>, const LaneBodies&, TurnStage);
template void TurnPack::giveBack(std::span<JointPack<1>* const>) const;
template void TurnPack::giveBack(std::span<JointPack<4>* const>) const;

}  // namespace physics
