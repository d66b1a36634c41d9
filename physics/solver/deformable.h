// Ropes, cloth and soft bodies: points that constraints join, of any number at a time. Where the
// factor of their rows has little fill, as a rope's, they are solved at once; so is what holds
// points to each other where that alone has, as the links of a cloth; the rest is swept, projected
// Gauss-Seidel. All over the same
//   (J M^-1 J^T + alpha) lambda = -(c + J (u - u_0))
// as an articulation's: evaluated at X + u_0, where the substep was predicted to end. They start
// from lambda = 0: the directions of a mesh turn too quickly for the last ones to be worth having.
//   position   c + alpha lambda = 0; a push f that falls off by K has alpha = K^-1, c = -K^-1 f
//   velocity   J u = 0 for what holds; forces and what gives way have no error to take back
// u, lambda: displacements of a substep, impulses times the step.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/solver/block_factor.h"
#include "physics/solver/soft_rows.h"
#include "physics/solver/sparse_factor.h"
#include "physics/solver/swept_row.h"

namespace physics {

// What joins bodies: rows between points, and how much a factor would fill up: the length of its
// columns, squared, on the average.
struct Mesh {
  bool points = false;
  double fill = 0;
};
Mesh meshOf(const SweptRows& rows, std::span<const InverseMass> masses);
// Of a factor worth having: a net of bodies, 25 by 25, has 192; solved at once it takes as long as
// swept, and its joints are open by a thousandth. Rows of points are cheap to sweep.
inline constexpr double kMostFill = 400, kMostFillOfPoints = 16;

// Keeps the factor regular where rows repeat each other: relative to the row's own A.
inline constexpr double kRedundancy = 1e-7;

// What the links of a cloth give way by where none is asked for, relative to their own A, in a
// substep as long as the step. It is a compliance, the same in all substeps: with one that went
// with their length what is stretched would gain energy where the next one is shorter.
inline constexpr double kGivesInStep = 1e-8;

// What a piece between two points may turn by in a step of Newton's [rad]: further on, the rows
// that were evaluated before say nothing of where it ends.
inline constexpr double kFarTurn = 0.5;
// By so much rows are taken as straight, [rad]: what is off is of second order.
inline constexpr double kStraightTurn = 0.05;
inline constexpr int kMostRounds = 30;  // of finding which rows are at a bound
inline constexpr int kMostSteps = 20;   // of Newton's; two to four are enough, but where a rope is
                                        // caught

// M + K and the rows as one symmetric matrix, for d, the change of u, and -lambda (of velocities,
// where K = 0, its change):
//   M + K   J^T
//   J      -alpha
// with the geometric stiffness K of what pulls, without which a heavy end on light links gains
// energy. What is held at a bound keeps its place in the pattern.
struct MeshFactor {
  SparseFactor factor;
  std::vector<std::array<int, 2>> entries;  // in the order that they are written in
  Eigen::VectorXd right, solution;
  bool stale = true;
};

// How a piece along the unit vector d resists being turned while it pulls:
//   pull/length (1 - d d^T)
Mat3 turningStiffness(const Vec3& d, double pull, double length);

// Of a cloth: what holds its points, with the normal rows of their contacts and the bodies that
// touch them, without lambda, which alpha > 0 eliminates, by blocks of points, bodies and their
// turns:
//   (M + K + J^T alpha^-1 J) d = J^T (lambda - alpha^-1 (c + J (u - u_0) + alpha lambda)) - given
// In turns with what holds the points, a contact takes from a body no more momentum than its node
// can have, and the next one takes it from what that gave back: bodies that fall on a taut cloth
// gained energy.
struct PointFactor {
  struct Row {
    Mat3 stiffness = Mat3::Zero(), turning = Mat3::Zero();  // J^T alpha^-1 J + K; K
    Vec3 given = Vec3::Zero();  // impulse on its first body, in this substep
    Vec3 next = Vec3::Zero();   // and the next one, of d = 0
  };
  struct Pressed {
    SoftRow* row = nullptr;
    std::array<int, 4> place = {-1, -1, -1, -1};  // of its points, its body, that body's turn
  };
  // A total length that the links do not imply, beside the blocks.
  struct Length {
    std::vector<int> place;         // of its bodies
    std::vector<Mat3> turning;      // K of its pieces
    std::vector<Vec3> given, push;  // impulses on its bodies in this substep, and the next ones
    std::vector<Vec3> answer;       // of the factor to J^T; empty: not asked yet
    double gives = 0;               // alpha
    double next = 0;                // change of lambda
    bool held = true;               // slack
  };
  BlockFactor<3> factor;
  std::vector<Row> rows;
  std::vector<Length> lengths;
  std::vector<Pressed> pressed;
  std::vector<int> turn;      // by place in solved_: the place of its turn, -1: none
  std::vector<Mat3> massive;  // M, by place
  std::vector<Vec3> change;   // d, by place
  std::vector<Vec3> from;     // by place: u that K turns from
  std::vector<BlockFactor<3>::Sides> sides;
  bool stale = true;
};

class Deformable {
 public:
  Deformable(SweptRows rows, const Kinds& kinds, std::span<const InverseMass> masses, bool direct);

  std::span<const BodyId> bodies() const { return bodies_; }
  bool isDirect() const { return factor_ != nullptr; }
  bool isAtOnce() const { return factor_ || points_; }
  bool hasPointsAtOnce() const { return points_ != nullptr; }
  std::size_t size() const { return size_; }

  // What is solved at once, by Newton's method, with the normal rows of the contacts of its points
  // and the bodies that touch them: what presses on a light one in several places moves it once. An
  // overlap is taken back by at most `push` [m]. Steps of Newton's go on until one changes the way
  // of points by no more than `closed` of it: what holds them then is off by its square.
  void solvePositions(const JointStage& stage, double step, double push, double closed,
                      std::span<SoftRow> rows);
  void sweepPositions(const JointStage& stage);  // the rest
  // At the end of the substep.
  void prepareVelocities(const Kinds& kinds, const Configuration& at,
                         std::span<const JointMass> masses, std::span<const Displacement> moved);
  void sweepVelocities(std::span<const JointMass> masses, std::span<Displacement> moved);
  // What holds is off by, relative to its extent, on the average of what it carries.
  double strain(const Kinds& kinds, const Configuration& at);
  // The most that a piece between two points has turned by in the substep [rad].
  double turn(const Configuration& at) const;
  // Writes the multipliers back to the kinds' sets.
  void finish(Kinds& kinds, double dt) const;
  void goOn(const Kinds& kinds);  // from the multipliers that stand there
  // What a substep knows of the one before: as it is now, and as it was then.
  void keep();
  void goBack();

 private:
  // Evaluates all rows where `moved` takes the bodies from the start of the substep: the first time
  // in it, or again, for another step of Newton's.
  void evaluate(const JointStage& stage, bool first);
  void evaluateRows(const JointStage& stage, bool first);
  void findImplied(const Kinds& kinds);
  // Of points that are solved at once.
  void choosePoints(const Kinds& kinds, std::span<const InverseMass> masses);
  template <class F>
  void forEachPair(F&& f);
  template <class F>
  void forEachBlockOf(const PointFactor::Pressed& pressed, F&& f) const;
  void layOutPoints();
  void takePressed();
  void factorizePoints();
  void takeStiffness(std::span<const JointMass> masses, bool first);
  Vec3 apartBy(const SweptItem& swept) const;
  double shareOfChange();
  void turnFrom(std::span<const Displacement> moved);
  Vec3 turnedBy(int place, std::span<const Displacement> moved) const;
  void aimAtPoints(bool positions, std::span<const Displacement> moved);
  bool choosePressed(bool positions, std::span<const Displacement> moved);
  void takeChange(double share, std::span<const JointMass> masses, std::span<Displacement> moved);
  double solvePoints(bool positions, bool first, std::span<const JointMass> masses,
                     std::span<Displacement> moved);
  void solvePointPositions(const JointStage& stage, double closed);
  void preparePointVelocities(std::span<const Displacement> moved);

  // Of total lengths beside them.
  struct FreeLength {
    SweptRow<1>* swept;
    PointFactor::Length* length;
    double error;  // c + J (u - u_0)
  };
  template <class F>
  void forEachLength(F&& f);
  void takeLengthsAtOnce();
  void layOutLengths(std::vector<std::array<int, 2>>& pieces);
  void takeLengths(bool first);
  void aimAtLengths(std::span<const Displacement> moved);
  double changeAlong(const SweptRow<1>& swept, const PointFactor::Length& length,
                     std::span<const Vec3> change) const;
  void askFactor(std::span<const FreeLength> lengths);
  void solveLengths(std::span<const Displacement> moved);
  bool chooseLengths(bool positions, std::span<const Displacement> moved);
  void takeLengthChange(double share, std::span<const JointMass> masses,
                        std::span<Displacement> moved);
  void prepareLengthVelocities();

  // Of contacts, and of what is solved at once with all of its rows.
  void solveAllPositions(const JointStage& stage);
  void takeMasses(std::span<const JointMass> masses);
  bool isOwn(BodyId body) const;
  int placeOf(BodyId body) const;  // in solved_; -1: it does not move
  void takeContacts(std::span<SoftRow> rows, double push);
  void takeLaid();
  Displacement changeOf(BodyId body) const;
  bool chooseContacts(bool positions, bool first, std::span<const Displacement> moved);
  void aimAtPositions(std::span<const Displacement> moved);
  template <int kRows>
  typename SweptRow<kRows>::Vector changeAlong(const SweptRow<kRows>& swept) const;
  double changeAlong(const SoftRow& row) const;
  void solveProgram(bool first, std::span<const Displacement> moved);
  bool chooseAgain(bool isLate, std::span<const Displacement> moved);
  double shareOfStep(std::span<const Pose> pose, std::span<const Displacement> moved) const;
  void takePositions(double share, std::span<Displacement> moved);
  void noteStart(std::span<const Displacement> moved);
  bool isClosed(std::span<const Displacement> moved, double closed) const;
  void solveVelocities(std::span<Displacement> moved);
  void factorize(bool positions);
  void solveFactor();
  // What keeps the factor regular is a compliance of it.
  static bool givesInLine(const SweptItem& swept) { return swept.isLength && !swept.isImplied; }
  double leastOf(const SweptItem& swept) const;
  template <class F>
  void emit(bool positions, F&& entry);
  double errorNow(const SoftRow& row, bool positions, std::span<const Displacement> moved) const;
  void chooseFree(bool positions, bool first, std::span<const Displacement> moved);
  bool holdAtBounds(std::span<Displacement> moved);

  SweptRows rows_;
  std::unique_ptr<MeshFactor> factor_;   // none: swept
  std::unique_ptr<PointFactor> points_;  // of what is swept; none: nothing of it is solved at once
  std::vector<int> unknown_;             // by place in solved_: the first of its 3 or 6
  std::vector<bool> turns_;              // by place: it has 6
  int unknowns_ = 0;                     // of bodies
  bool repeats_ = false;                 // rows are more than its bodies can move by in shape
  std::vector<Mat3> inertia_;            // by place
  std::vector<double> mass_;
  std::vector<Displacement> from_;             // by place: u_0
  std::vector<std::array<BodyId, 2>> pieces_;  // straight ones, between two points
  std::vector<SoftRow*> contacts_;
  // Of the contacts: those that the factor has rows for, and those found.
  std::vector<std::array<BodyId, 3>> laid_, found_;
  double gives_ = 0;  // what rigid links of a cloth, and total lengths, give way by, of own A
  double before_ = 0, beforeKept_ = 0;  // length of the last substep [s]; 0: none
  double push_ = 0;                     // overlap taken back in a substep, at the most [m]
  std::vector<BodyId> bodies_;          // those that move, sorted
  std::vector<BodyId> solved_;  // those, and bodies that touch them: what a factor solves for
  std::size_t size_ = 0;
  Row<kMany, 1> many_;  // to work in
};

}  // namespace physics
