// A tree of bodies on ball sockets, or of points on links, held by the world at one of them at the
// most; or one body alone. Where its bodies, or links, are turned to tells where they are, so that
// no joint opens, and how they turn how fast they are: a step turns them at their spins by h/2,
// kicks them by h there, and turns them by h/2 once more. It is symmetric in time, as
// SymmetricStep's, and iterates nothing. Motions of several numbers of steps over the same time, as
// extrapolation has them, are made side by side in lanes.
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

class JointTree {
 public:
  struct Body {  // by place
    bool moves = false, turns = false;
    double mass = 0;              // kg
    Vec3 inertia = Vec3::Zero();  // principal [kg m^2]
  };
  struct Joint {                  // in the order of the topology
    std::array<Vec3, 2> anchors;  // of a socket, in body frames
    double length = 0;            // m, of a link; 0: a socket
  };
  // None: of other joints, of both kinds, with bodies on links that turn, or some that close a
  // loop.
  static std::optional<JointTree> of(std::shared_ptr<const JointTopology> topology,
                                     std::span<const Joint> joints, std::span<const Body> bodies);

  // What is the same in all steps: accelerations [m/s^2] and torques [N m], by place.
  void push(std::span<const Vec3> pulls, std::span<const Vec3> torques);
  // From a state, motions of `first`, first + 1, ... steps over `time`, so many as columns.
  void run(int first, int columns, const IslandState& from, double time,
           const TreeKernels& kernels = treeKernels());
  // Where one of them ends, counted from 0.
  void end(int row, IslandState& state) const;
  // Places and velocities there by turns and spins; of links by how they are directed.
  void place(IslandState& state) const;

 private:
  JointTree() = default;
  void layOut();
  bool findWalk(const JointTopology& topology);
  TreeView view();
  void begin();
  void begin(int lane);
  void takeEnd(int row, int lane);
  void beginAt(std::size_t motion, const Quat& turn, const Vec3& omega);
  void walkSockets(IslandState& state) const;
  void walkLinks(IslandState& state) const;
  void takeCentre(IslandState& state) const;

  std::shared_ptr<const JointTopology> topology_;
  std::vector<Body> bodiesOf_;
  std::vector<Joint> jointsOf_;
  struct Step {  // of a walk from what stands: the joint, and at which end of it one comes
    int joint, from;
  };
  std::vector<Step> walk_;
  bool isOfLinks_ = false;
  bool isFree_ = false;  // the world holds none of it
  std::vector<TreeBody> bodies_;
  std::vector<TreeMotion> motion_, start_, ends_;  // ends_: four motions side by side, then four
  std::vector<TreeTurn> turns_;
  std::vector<TreeJoint> joints_;
  std::vector<TreeNum> diagonal_, lower_, upper_;
  std::vector<TreeNum> alpha_;
  IslandState from_;
  double time_ = 0;
};

}  // namespace physics
