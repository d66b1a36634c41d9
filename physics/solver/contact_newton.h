// Normal loads of contacts at once, where sweeps do not find them: light bodies under heavy ones.
//
// A stage of a substep minimizes over what bodies move by
//   1/2 (u - u0)^T M (u - u0) + sum k/2 min(0, J u + e)^2,   lambda = -k min(0, J u + e)
// with u0 without these loads, and of each point the aim e and the stiffness k of its law; what
// gives way to nothing is 1e6 times as stiff as its bodies resist, about the loads it had before,
// so that from one solve to the next it gives way to nothing indeed. Joints are rows of the sum
// that stay as far open as they are. That is convex, and quadratic as long as the same points
// press: Newton's method, whose steps are cut where they do not go down, ends after a few. Its
// matrix couples bodies that touch or are joined. After E. Todorov, "Convex and analytically-
// invertible dynamics with contacts and constraints", ICRA 2014.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/solver/block_factor.h"
#include "physics/solver/contact_block.h"

namespace physics {

class ContactNewton {
 public:
  // Steps of Newton's. Which points press changes from one to the next; a solve with joints that
  // does not end is not taken, and one without goes on in the next from what pressed in the end.
  static constexpr int kMostSteps = 32;
  using Six = Eigen::Matrix<double, 6, 1>;  // u, and turns in the units of the lanes
  using Rows = Eigen::Matrix<double, 3, 6, Eigen::RowMajor>;
  using RowSix = Eigen::Matrix<double, 1, 6>;
  // A row of joints, by slots, 0: what does not move. It stays as far open as it is, but for what
  // gives way by alpha; no rows: it is not at work.
  struct Joint {
    int a = 0, b = 0, rows = 0;
    Rows ofA, ofB;
    Mat3 alpha;
  };
  std::vector<Joint> joints;

  // Of which bodies touch or have joints. Allocates, where these are others than before.
  void layOut(std::span<const ContactBlock> blocks, std::span<const LaneMass> masses);
  double multiplications() const;  // of a factor, about
  double fill() const { return factor_.fill(); }

  // From the loads that blocks and motions have to those of a stage; friction stays as it is, and
  // bodies do not move by what joints make of it: these are to follow.
  void solvePositions(std::span<ContactBlock> blocks, std::span<LaneMotion> motions,
                      PositionSweep which);
  void solveVelocities(std::span<ContactBlock> blocks, std::span<LaneMotion> motions,
                       int mostSteps = kMostSteps);

 private:
  using Motions = std::vector<Six>;  // by slot
  struct Law {
    double aim, stiffness;
    bool isHard;  // its loads go on from those of before
  };
  struct Pair {  // of bodies, by slots; its block of the matrix, -1: one of them is given
    int a = 0, b = 0, entry = -1;
  };
  struct Row {  // a point of a contact: J of both
    int contact;
    RowSix ofA, ofB;
    double aim, stiffness;
    double before, lambda;
    float* stored;
    bool presses;
  };
  struct Along {  // of a row, on the way of a step
    double from, change, stiffness;
  };
  struct Held {  // of a joint: the inverse of alpha and a little, J u at the start
    Mat3 stiffness;
    Vec3 start;
  };

  Pair pairOf(int a, int b);
  template <class LawOf>
  void takeRows(std::span<ContactBlock> blocks, LawOf&& lawOf);
  void solve(std::span<LaneMotion> motions, std::vector<char>& pressed, int mostSteps);
  void start(std::span<const LaneMotion> motions);
  bool markPressing(const Motions& x);
  double valueOf(const Motions& x) const;
  double findLeast();
  void minimize(Motions& x);
  bool descend(int mostSteps);
  Mat3 stiffnessOf(const Joint& joint) const;
  void holdJoints();
  template <class J, class K>
  void add(const Pair& pair, const J& ofA, const J& ofB, const K& kA, const K& kB);
  double gainOf(const Motions& x) const;
  Six moved(int slot, const Six& impulse) const;
  void push(const Pair& pair, const Row& row, double lambda, Motions& x) const;
  double rateOf(const Row& row, const Motions& x) const;
  double wayOf(const Row& row, const Motions& x) const;
  Vec3 rateOf(const Joint& joint, const Motions& x) const;

  std::vector<int> places_;                                  // by slot: in the matrix; -1: given
  std::vector<double> inverse_;                              // by slot: 1/m
  std::vector<std::array<int, 2>> entries_, entriesBefore_;  // of the factor, as it is laid out
  BlockFactor<6> factor_;
  std::vector<Pair> contacts_, joined_;  // as blocks and joints have them
  std::vector<Row> rows_;
  std::vector<PositionAims> aims_;
  Motions before_, x_, next_;  // but for what moves without these loads
  Motions pulls_, solved_;     // by place: of joints, on the right-hand side; and all of it
  std::vector<Along> along_;
  std::vector<Held> held_;
  struct {  // by row, where the last solve ended: the next one in a step begins there
    std::vector<char> inPositions, inVelocities;
  } pressed_;
};

}  // namespace physics
