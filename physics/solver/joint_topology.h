// Which rows an articulation has, in which order they are eliminated, and which blocks that fills:
// an order that has no fill for chains and trees. Articulations of equal topology share one.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/bodies/body.h"
#include "physics/solver/joint_block.h"
#include "physics/solver/joint_row.h"

namespace physics {

struct JointTopology {
  int index = 0;               // in the order that topologies were met
  std::vector<int> signature;  // rows, their kinds and bodies: equal where topologies are
  std::vector<int> order;      // of elimination: which of the rows as they were given
  int bodyCount = 0;
  std::vector<char> moves;   // by body
  std::vector<int> others;   // rows that the kernels do not evaluate
  std::vector<int> bounded;  // rows that may have bounds, but for those of the tail
  std::vector<JointShape> shapes;
  std::vector<JointColumn> columns;
  std::vector<JointBelow> below;
  std::vector<int> updates;            // blocks, by column
  std::vector<int> updatesAt;          // where those begin in a factor
  std::vector<JointMeeting> meetings;  // by block
  int lower = 0;                       // numbers of the blocks below the diagonal
  bool isTree = false;                 // no two rows can say the same
  int tailStart = 0;                   // of the rows: limits, which come last
  std::vector<JointPair> tail;         // those of them that share a body
};

using JointTopologies = std::vector<std::shared_ptr<const JointTopology>>;

// That of `known` with these rows, or a new one. `bodies`: those of the rows, sorted.
std::shared_ptr<const JointTopology> topologyOf(std::span<const JointRef> refs,
                                                std::span<const JointKind> kinds,
                                                std::span<const BodyId> bodies,
                                                std::span<const InverseMass> masses,
                                                JointTopologies& known);

}  // namespace physics
