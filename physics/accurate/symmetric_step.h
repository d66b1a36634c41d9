// A step of an island that joints hold and forces push, symmetric in time, so that its error has
// even powers of h only:
//   X' = X + h V + h^2/2 M^-1 (f + J^T lambda),   c(X') = 0,   J of the joints at X
//   V' = V + h M^-1 (f + (J^T lambda + J'^T mu)/2),   J' V' = 0                        RATTLE
// f at the middle of X and X', so that stiff springs are stable at any h; bodies turn between
// impulses by the trapezoidal rule for their momentum, motion/free_motion.h. Here lambda and mu are
// displacements: h^2/2 times the forces of (2).
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "physics/accurate/cross_system.h"
#include "physics/accurate/island_state.h"
#include "physics/accurate/joint_tree.h"
#include "physics/motion/free_motion.h"
#include "physics/solver/joint_row.h"

namespace physics {

class Archive;

// Poses by BodyId that rows are evaluated at. Bodies of other islands stand where they are.
struct TrialPoses {
  std::span<Pose> now, start, end;
};

// What the world does to bodies, by BodyId.
struct Surroundings {
  Kinds& kinds;  // what follows a table over time is set to each step's mean
  const Bodies& bodies;
  std::span<const Load> loads;
  Vec3 gravity = Vec3::Zero();
  double time = 0;  // s, where a motion starts
};

template <class Row>
void takeRow(const Row& row, IslandRow& to) {
  for (int b = 0; b < JointRow::kMostBodies; ++b) {
    if (to.form == IslandRow::Form::kSingle) {
      to.linear[b].row(0) = row.linear[b].row(0);
      to.angular[b].row(0) = row.angular[b].row(0);
      continue;
    }
    to.linear[b] = row.linear[b];
    to.angular[b] = row.angular[b];
  }
}

class SymmetricStep {
 public:
  // Of `refs` and the bodies that move in it.
  SymmetricStep(std::span<const JointRef> refs, std::span<const BodyId> moving,
                const Surroundings& world, JointTopologies& known);

  // False: some are not smooth, or of more than two bodies, or of one that moves by itself.
  static bool takes(std::span<const JointRef> refs, const Surroundings& world);

  // A limit holds something now: where that ends no step tells.
  bool isLimited(const Kinds& kinds) const;

  std::span<const BodyId> bodies() const { return bodies_; }
  bool isJoined() const { return !refs_.empty(); }
  bool moves(std::size_t place) const { return moves_[place]; }
  bool turns(std::size_t place) const { return moves_[place] && !inverseInertia_[place].isZero(0); }
  double size() const { return size_; }      // m: the largest extent that the island has had
  double finest() const { return finest_; }  // m: its joints close no further
  double speed() const { return speed_; }    // m/s: and the largest of its points' speeds

  // m, by place: how far points of a body have been from its centre, those of its joints too; 0
  // where it does not turn.
  std::span<const double> levers() const { return levers_; }

  // Puts the island into a state: rows and factor there. Where it ended it goes on.
  void set(const IslandState& state, const Surroundings& world, const TrialPoses& trial);
  const IslandState& state() const { return present_.state; }
  // Spins as angular momenta, over the largest moment of each body, and back: what a flight keeps
  // is kept by what is linear in it.
  void takeMomenta(IslandState& state) const;
  void takeSpins(IslandState& state) const;
  // Back to the state of the last `set`.
  void restart();
  // Of the last `set`: some force damps what it holds within `time`, in which nothing swings. Steps
  // are to come in pairs.
  bool dampsWithin(double time, const Surroundings& world, const TrialPoses& trial);
  // From where it is by h, joints closed to `tolerance` [m, rad]. False: they do not close, or a
  // limit is met.
  bool step(double h, double tolerance, const Surroundings& world, const TrialPoses& trial);
  // Joints make a loop: its rows may depend on each other, and where they do it may go on by more
  // than one branch.
  bool isLoop() const { return !topology_->isTree; }
  // m: how far the way of a loop's step is from what the velocities at its ends tell, where that is
  // not of a smooth motion: the furthest since restart(). Another branch than the one it came by
  // stops bodies at once.
  double jump() const { return jump_; }
  // A tree of ball sockets: of the state of the last `set`, motions of `first`, first + 1, ...
  // steps, so many as columns, which tree().end() tells. False: a limit is met.
  bool isTree() const { return tree_.has_value(); }
  bool stepSideBySide(int first, int columns, double time, const Surroundings& world,
                      const TrialPoses& trial);
  const JointTree& tree() const { return *tree_; }
  // To the turns and spins of a state near the ends of those.
  void goOnFrom(const IslandState& state, const TrialPoses& trial);
  // To a state near the present one: joints closed, and no velocity that opens them. It is then as
  // after `set`.
  bool project(const IslandState& state, double tolerance, const Surroundings& world,
               const TrialPoses& trial);
  void archive(Archive& a);

 private:
  static constexpr int kMostIterations = 16;  // a digit a try, and there are 16

  // What tells of a joint's force, as its lambda in steps of one second.
  struct Pull {
    Vec3 next = Vec3::Zero(), change = Vec3::Zero();
  };
  // A body's, in the tries of a step.
  struct Spin {
    Mat3 turned;                      // from its own frame, where the step begins
    Vec3 pushed, start, omega, mean;  // kg m^2/s; rad/s in its own frame: at the start, halfway
  };
  // All that a step changes.
  struct Present {
    IslandState state;
    std::vector<IslandRow> rows;
    std::vector<BodyInverse> inverse;
    std::vector<Pull> pulls;
    RowSystem joints;
    double h = 0;  // of the last step
  };
  void put(const IslandState& state, std::span<Pose> to) const;
  bool isAt(const IslandState& state) const;
  void put(const IslandState& state, const Surroundings& world, const TrialPoses& trial);
  void measure(const Surroundings& world, const TrialPoses& trial);
  void turnInertia();
  template <class Change>  // of the spin of each body that has several, in its own frame
  void changeSpins(IslandState& state, const Change& change) const;
  double leverOf(std::size_t place, const Surroundings& world) const;
  double speedOf(std::size_t place, const Velocity& velocity) const;
  void lookAt(const IslandState& at, std::span<const Pose> now, const TrialPoses& trial,
              const Surroundings& world, double h);
  void lookAtForces(const Surroundings& world, const TrialPoses& trial, double h);
  void guess(double h);
  void sum();
  void begin(double h, const Surroundings& world);
  bool move(double h, const Surroundings& world);
  bool resolvesForces() const;
  double mobilityOf(std::size_t row, const IslandRow& of) const;
  double tryOut(double h, const Surroundings& world, const TrialPoses& trial);
  void correct();
  bool close(double h, double tolerance, const Surroundings& world, const TrialPoses& trial);
  bool closeAcross(double h, double tolerance, const Surroundings& world, const TrialPoses& trial);
  void finish(double h, const Surroundings& world);
  void takeRows();
  void stop(double h);
  double jumpFrom(const IslandState& before, double h) const;
  bool meetsLimit(const Surroundings& world, const TrialPoses& trial) const;
  Vec3 momentumOf(std::size_t body) const;
  Vec3 pullOn(std::size_t body, const Surroundings& world) const;

  std::vector<BodyId> bodies_;
  std::vector<bool> moves_;
  std::vector<Vec3> inertia_, inverseInertia_;  // principal
  double size_ = 0, speed_ = 0, finest_ = 0;
  std::vector<double> levers_;
  std::vector<JointRef> refs_, limits_;  // refs_ in the order of elimination
  std::vector<bool> isForce_, isDamped_;
  std::vector<std::array<Vec3, 2>> anchors_;  // of gaps, in body frames
  bool hasForces_ = false;
  bool isSeenAway_ = false;  // some rows are evaluated at TrialPoses
  bool isMade_ = true;       // rows and factor are there; false after its bytes were read
  std::shared_ptr<const JointTopology> topology_;
  std::optional<JointTree> tree_;
  Present present_, first_;
  bool hasStepped_ = false;  // from first_
  RowSystem all_;            // with the forces
  CrossSystem across_;
  std::vector<Vec3> error_, lambda_;
  std::vector<IslandRow> ahead_;  // of joints, where the step ends
  IslandState to_, before_;
  double jump_ = 0;
  std::vector<Spin> spins_;
  std::vector<Vec3> shift_, twist_, momentum_;  // of impulses [m, kg m^2], and halfway
};

}  // namespace physics
