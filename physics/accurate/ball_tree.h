// A tree of bodies on ball sockets, held by the world at one body at the most. Where bodies are
// turned to tells where they are, so that no joint opens, and how they turn how fast they are: a
// step turns them freely by h/2, kicks them by h there, and turns them by h/2 once more. It is
// symmetric in time, as SymmetricStep's, and iterates nothing. Motions of 1, 2, ... k steps over
// the same time, as extrapolation has them, are made side by side in lanes.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/accurate/island_state.h"
#include "physics/accurate/tree_block.h"
#include "physics/solver/joint_topology.h"

namespace physics {

class BallTree {
 public:
  struct Body {  // by place
    bool moves = false, turns = false;
    double mass = 0;              // kg
    Vec3 inertia = Vec3::Zero();  // principal [kg m^2]
  };
  // None: joints of other kinds, or some that close a loop. `anchors`: of its gaps, in body frames.
  static std::optional<BallTree> of(std::shared_ptr<const JointTopology> topology,
                                    std::span<const std::array<Vec3, 2>> anchors,
                                    std::span<const Body> bodies);

  // What is the same in all steps: accelerations [m/s^2] and torques [N m], by place.
  void push(std::span<const Vec3> pulls, std::span<const Vec3> torques);
  // From a state, motions of 1, 2, ... `columns` steps over `time`.
  void run(int columns, const IslandState& from, double time,
           const TreeKernels& kernels = treeKernels());
  // Where that of n steps ends.
  void end(int n, IslandState& state) const;
  // Places and velocities there by turns and spins.
  void place(IslandState& state) const;

 private:
  BallTree() = default;
  bool findLinks(const JointTopology& topology);
  TreeView view();
  void begin();
  void begin(int lane);
  void takeEnd(int n, int lane);

  std::shared_ptr<const JointTopology> topology_;
  std::vector<Body> of_;
  std::vector<std::array<Vec3, 2>> anchors_;
  std::vector<TreeLink> links_;
  bool isFree_ = false;  // the world holds none of it
  std::vector<TreeBody> bodies_;
  std::vector<TreeMotion> motion_, start_, ends_;  // ends_: four motions side by side, then four
  std::vector<TreeTurn> turns_;
  std::vector<TreeJoint> joints_;
  std::vector<TreeNum> diagonal_, lower_, upper_;
  IslandState from_;
  double time_ = 0;
};

}  // namespace physics
