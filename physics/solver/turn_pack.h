// Up to eight articulations of equal topology in turns with contacts: what the kernel of
// turn_block.h works on, copied from the packs that have seen their rows and factored them.
#pragma once

#include <span>
#include <vector>

#include "physics/solver/joint_topology.h"
#include "physics/solver/lane_mass.h"
#include "physics/solver/turn_block.h"

namespace physics {

template <int W>
class JointPack;

enum class TurnStage : char { kPositions, kVelocities };

class TurnPack {
 public:
  // Trees of gaps, with limits that come last. Rows that repeat each other need a factor in double
  // precision, and what has other bounds is held at them by the pack.
  static bool serves(const JointTopology& topology);
  // Rows as the packs, each beside the other, have seen them.
  template <int W>
  void take(std::span<JointPack<W>* const> packs, const LaneBodies& lanes, TurnStage stage);
  void follow(std::span<LaneMotion> motions);
  // What rows carry, and which limits do not, back to the packs.
  template <int W>
  void giveBack(std::span<JointPack<W>* const> packs) const;

 private:
  void layOut(const JointTopology& topology);
  void layOutRow(const JointTopology& topology, int row, int numbers);
  void clear();
  template <int W>
  void fillFactor(const JointPack<W>& pack, int lane);
  template <int W>
  void fillRows(const JointPack<W>& pack, int lane, const LaneBodies& lanes, TurnStage stage);
  template <int W>
  void fillGap(const JointPack<W>& pack, int row, int lane, TurnStage stage);
  template <int W>
  void fillLimit(const JointPack<W>& pack, int place, int lane, TurnStage stage);
  template <int W>
  void fillBody(const JointPack<W>& pack, int body, int lane, const LaneBodies& lanes);

  std::vector<char> usedLimits_;       // of the tail, in any pack
  std::vector<int> movers_, moverOf_;  // bodies that move, and the place of each, -1: none
  std::vector<int> limits_, limitOf_;  // the same of the tail's rows
  std::vector<TurnBody> bodies_;
  std::vector<TurnMotion> motions_;
  std::vector<TurnRow> rows_;
  std::vector<int> below_;
  std::vector<Eight> numbers_, right_, lambda_, tail_, factor_, held_;
  std::vector<TurnLimit> limitNumbers_;
  std::vector<char> gives_;
  bool isFactored_ = false;
};

}  // namespace physics
