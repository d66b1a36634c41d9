// Normal loads of contacts at once, where sweeps do not find them: light bodies under heavy ones.
//
// A stage of a substep minimizes over what bodies move by
//   1/2 (u - u0)^T M (u - u0) + sum k/2 min(0, J u + e)^2,   lambda = -k min(0, J u + e)
// with u0 without these loads, and of each point the aim e and the stiffness k of its law; what
// gives way to nothing is 1e6 times as stiff as its bodies resist, about the loads it had before,
// so that from one solve to the next it gives way to nothing indeed. Joints are rows of the sum
// that stay as far open as they are. That is convex, and quadratic as long as the same points
// press: Newton's method, with steps as long as they go down, ends after a few. Its matrix couples
// bodies that touch or are joined. After E. Todorov, "Convex and analytically-invertible dynamics
// with contacts and constraints", ICRA 2014.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/solver/block_factor.h"
#include "physics/solver/contact_block.h"

namespace physics {

class ContactNewton {
 public:
  // A row of joints, by slots, 0: what does not move. It stays as far open as it is, but for what
  // gives way by alpha; no rows: it is not at work.
  struct Joint {
    int a = 0, b = 0, rows = 0;
    Mat3 linearA, linearB, turnA, turnB, alpha;
  };
  std::vector<Joint> joints;

  // Of which bodies touch or have joints. Allocates, as long as there are more than before.
  void layOut(std::span<const ContactBlock> blocks, std::span<const LaneMass> masses);
  double productCount() const { return factor_.size() * factor_.fill(); }  // of a factor's blocks

  // From the loads that blocks and motions have to those of a stage; friction stays as it is, and
  // bodies do not move by what joints make of it: these are to follow.
  void solvePositions(std::span<ContactBlock> blocks, std::span<LaneMotion> motions,
                      PositionSweep which);
  void solveVelocities(std::span<ContactBlock> blocks, std::span<LaneMotion> motions);

 private:
  struct Motion {  // turns in the units of the lanes
    Vec3 u = Vec3::Zero(), turn = Vec3::Zero();
  };
  using Motions = std::vector<Motion>;  // by slot
  struct Law {
    double aim, stiffness;
    bool isHard;  // its loads go on from those of before
  };
  struct Contact {
    int a, b;                // slots
    std::size_t first, end;  // rows
  };
  struct Row {  // a point
    Vec3 n, wA, wB;
    double aim, stiffness;
    double before, lambda;
    float* stored;
    bool presses;
  };
  struct Block {  // of a body and itself or another: of u and turns
    Mat3 u, uTurn, turnU, turn;
  };

  struct Along {  // of a row, on the way of a step
    double from, change, stiffness;
  };
  struct Share {  // of a joint in the matrix and the right-hand side of one of its bodies
    Mat3 u, turnU, turn;
    Vec3 pull, pullTurn;
  };
  struct Held {  // of a joint: the inverse of alpha and a little, J u at the start; what follows
    Mat3 stiffness;
    Vec3 start;
    Share a, b;
    Block between;
  };

  template <class LawOf>
  void takeRows(std::span<ContactBlock> blocks, LawOf&& lawOf);
  void solve(std::span<LaneMotion> motions);
  void start(std::span<const LaneMotion> motions);
  bool markPressing();
  void descend();
  double findLeast();
  void minimize(Motions& x);
  void addContact(const Contact& c, Block& between);
  Mat3 stiffnessOf(const Joint& joint) const;
  static Share shareOf(const Mat3& linear, const Mat3& turn, const Mat3& kLinear, const Mat3& kTurn,
                       const Vec3& start);
  void holdJoints();
  void addShare(int slot, const Share& share);
  void giveBetween(int a, int b, const Block& of);
  double gainOf(const Motions& x) const;
  void giveMatrix();
  void push(const Contact& c, const Row& row, double lambda, Motions& x) const;

  std::vector<int> places_;      // by slot: of its u in the matrix, its turn follows; -1: given
  std::vector<double> inverse_;  // by slot: 1/m
  std::vector<std::array<int, 2>> entries_, entriesBefore_;  // of the factor, as it is laid out
  BlockFactor factor_;
  std::vector<Contact> contacts_;
  std::vector<Row> rows_;
  std::vector<PositionAims> aims_;
  std::vector<Block> own_, between_;  // by slot, by contact
  Motions before_, x_, next_;         // but for what moves without these loads
  std::vector<Vec3> solved_;
  std::vector<Along> along_;
  std::vector<Held> held_;
};

}  // namespace physics
