// Bodies that constraints and forces join, solved as one block: all rows together, by a sparse
// factor L D L^T of
//   A = J M^-1 J^T + alpha                                                                     (42)
// in blocks of three, in an order that has no fill for chains and trees. Forces are rows as well: a
// push f that falls off by K is the constraint  J u + K^-1 lambda = K^-1 f, so that what is stiff
// is solved together, whatever its kind. What has bounds is free within them, and else held at one.
//   position   c(X + u) + alpha lambda = 0      Newton, the factor kept for the second step
//   velocity   J u = 0 for what holds; forces and what gives way have no error to take back
// u, lambda: displacements of a substep, impulses times the step.
#pragma once

#include <span>
#include <vector>

#include "physics/kinds.h"

namespace physics {

// What a body moves by in this substep [m, rad].
struct Displacement {
  Vec3 u = Vec3::Zero(), theta = Vec3::Zero();
};

// M^-1 as joints see it.
struct JointMass {
  double inverse = 0;           // 1/kg
  Mat3 inertia = Mat3::Zero();  // world, inverse
};

struct JointRow {
  static constexpr int kMostBodies = 2, kMostRows = 3;
  enum class Role : char { kConstraint, kForce, kLoad };  // a load does not change with X
  int kind = 0, item = 0;                                 // in Kinds, in its set
  int bodyCount = 0, rows = 0;
  std::array<BodyId, kMostBodies> bodies{};
  Role role = Role::kConstraint;
  bool active = true;                     // it has anything to say at this pose
  bool free = true;                       // lambda is solved for; else it is held at a bound
  bool pulls = false;                     // it has anchors, and so geometric stiffness
  double regularisation = 0, yields = 0;  // epsilon, and alpha = epsilon A of it (54)
  double low = 0, high = 0, longest = 0;  // bounds of the total
  Vec3 c = Vec3::Zero(), lambda = Vec3::Zero(), left = Vec3::Zero();
  Vec3 evaluatedAt = Vec3::Zero();  // J u there
  Mat3 alpha = Mat3::Zero();
  // J, and M^-1 J^T. Most linear parts are plus or minus one, or nothing, and are not multiplied
  // by.
  enum class Part : char { kNone, kPlus, kMinus, kFull };
  std::array<Part, kMostBodies> linearPart{}, angularPart{};
  std::array<Mat3, kMostBodies> linear, angular, responseLinear, responseAngular;
  std::array<double, kMostBodies> inverseMass{};
  std::array<Vec3, kMostBodies> arm;  // world, where it pulls
};

class Articulation {
 public:
  struct Ref {
    int kind, item;
  };
  // `rows` in the table's order; `masses` by BodyId tell which bodies move.
  Articulation(const std::vector<Ref>& rows, const Kinds& kinds,
               std::span<const InverseMass> masses);

  std::span<const BodyId> bodies() const { return bodies_; }
  std::size_t size() const { return rows_.size(); }

  // Adds the geometric stiffness of what it pulled with in the last substep, by BodyId.
  void stiffen(std::span<const Pose> pose, std::span<Mat3> stiffness) const;

  // Evaluates all rows, and solves for positions: `first` begins a substep of dt.
  void solvePositions(Kinds& kinds, const Configuration& at, bool first,
                      std::span<const JointMass> masses, std::span<Displacement> moved);
  // Before the first of these, where errors are taken back by at most so much [m, rad].
  void leave(Kinds& kinds, const Configuration& at, double most);
  // Evaluates at the end of the substep; then, as often as contacts are swept:
  void prepareVelocities(Kinds& kinds, const Configuration& at, std::span<const JointMass> masses);
  void solveVelocities(std::span<const JointMass> masses, std::span<Displacement> moved);
  // What it pulled with in the last substep.
  void forget();
  // Writes the multipliers back to the kinds' sets.
  void finish(Kinds& kinds, double dt) const;

 private:
  struct Column {
    std::vector<int> to, block;              // below the diagonal, in the order of elimination
    std::vector<std::array<int, 3>> update;  // to[p], to[q], block or -1 for the diagonal
  };
  struct Coupling {
    int block, later, laterBody, earlier, earlierBody;
  };
  void respond(JointRow& row, std::span<const JointMass> masses);
  // The parts of columns_ and couplings_ whose rows are free.
  struct Pattern {
    std::vector<char> free;
    std::vector<int> rows;
    std::vector<int> start;                 // per row of `rows`, into below; one more at the end
    std::vector<std::array<int, 2>> below;  // to, block
    std::vector<int> updateStart;
    std::vector<std::array<int, 3>> update;  // scaled block, block, target: -1 - row, or a block
    std::vector<Coupling> couplings;
    std::vector<int> blocks;  // used
  };
  void lay(Pattern& pattern) const;
  const Pattern& pattern();  // of the rows that are free now
  void factorize(std::span<const JointMass> masses);
  void substitute();
  void begin(std::span<const JointMass> masses, std::span<Displacement> moved);
  void chooseFree();
  Vec3 along(const JointRow& row, std::span<const Displacement> moved) const;
  void give(const JointRow& row, const Vec3& change, std::span<Displacement> moved) const;
  void apply(std::span<Displacement> moved);
  bool holdAtBounds(std::span<Displacement> moved);
  void evaluate(Kinds& kinds, const Configuration& at, bool all);

  std::vector<JointRow> rows_;       // in the order of elimination
  std::vector<BodyId> bodies_;       // those that move, sorted
  std::array<Pattern, 6> patterns_;  // those of late
  int nextPattern_ = 0;
  const Pattern* now_ = nullptr;  // the one that the factor is of
  std::vector<Column> columns_;
  std::vector<Coupling> couplings_;
  std::vector<Mat3> blocks_, scaled_, diagonal_, inverse_;
  std::vector<Vec3> right_;
  bool stale_ = true;  // the factor is of other free rows
};

// One row, evaluated by its kind.
void evaluateRow(const Kinds& kinds, const Configuration& at, JointRow& row);

}  // namespace physics
