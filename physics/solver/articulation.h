// Bodies that constraints and forces join, solved as one block: all rows together, by a sparse
// factor L D L^T of
//   A = J M^-1 J^T + alpha                                                                     (42)
// in blocks, in an order that has no fill for chains and trees. Forces are rows as well: a push f
// that falls off by K is the constraint  J u + K^-1 lambda = K^-1 f, so that what is stiff is
// solved together, whatever its kind. What has bounds is free within them, and else held at one.
//   position   c(X + u) + alpha lambda = 0      Newton, the factor kept for the next steps
//   velocity   J u = 0 for what holds; forces and what gives way have no error to take back
// u, lambda: displacements of a substep, impulses times the step. Articulations of equal topology
// step side by side, one to a lane; what is done in one knows nothing of the others.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "physics/solver/joint_topology.h"
#include "physics/solver/lane_mass.h"

namespace physics {

// What a body moves by in this substep [m, rad].
struct Displacement {
  Vec3 u = Vec3::Zero(), theta = Vec3::Zero();
};

// What joints may be off by before the last step of Newton's, of their arms: where more is left the
// step was too long, and is made again with more substeps. What a taut row of planks is off by by
// 1e-4 is a sag of 24 mm, and what takes that back is motion. No more substeps to take: up to
// `kNearlyClosed` it is left as it is.
inline constexpr double kClosed = 1e-7, kNearlyClosed = 1e-4;

// What impulses on some bodies of an articulation move these by while its joints hold, in the units
// of their lanes: the articulated mass that contacts see. With A = L D L^T it is
//   R = M^-1 - M^-1 J^T A^-1 J M^-1,   between bodies b, c:   delta_bc M_b^-1 - Y_b^T D^-1 Y_c
//   Y_b = L^-1 J M_b^-1
// of which only rows on the way from the joints of b to the last ones eliminated are not zero: a
// handful in chains and loops. No R is built: of what was given the pulls D^-1 Y_b p_b are kept,
// and each body looks at those of its own rows. Limits are left out: what holds one way only would
// pull in R, and what contacts give beyond it is energy.
class JointResponse {
 public:
  using Six = Eigen::Matrix<double, 6, 1>;  // along, and turns
  using SixBySix = Eigen::Matrix<double, 6, 6>;

  void clear();  // nothing is touched
  // The place of a body, by its number in the articulation: it is touched from now on.
  int touch(int body, int slot, const JointTopology& topology);
  std::size_t size() const { return slots_.size(); }
  int placeOf(std::size_t body) const { return size() > 0 ? at_[body] : -1; }  // -1: untouched
  int slotAt(int place) const { return slots_[place]; }
  void setMass(int place, const LaneMass& mass) { touched_[place].mass = mass; }

  void give(int place, const Six& impulse);
  Six takeGiven(int place);                      // none is left
  void forgetPulls();                            // once all that was given is taken
  Six movedBy(int place) const;                  // by what was given, to all of them
  SixBySix between(int place, int other) const;  // R
  const SixBySix& own(int place) const { return touched_[place].own; }  // the same of one

 private:
  template <int W>
  friend class JointPack;
  using Row = Eigen::Matrix<double, 3, 6, Eigen::RowMajor>;
  struct Entry {
    int row;       // of the articulation, in the order of elimination
    Row of, over;  // of Y, and of D^-1 Y
  };
  struct Body {
    int body;  // of the articulation
    LaneMass mass;
    SixBySix alone = SixBySix::Zero(), own = alone;  // M^-1, R
    Six given = Six::Zero();
  };
  template <class Entries>
  auto entriesOf(Entries& entries, int place) const {
    return std::span(entries).subspan(starts_[place], starts_[place + 1] - starts_[place]);
  }
  std::vector<int> at_;         // by body of the articulation
  std::vector<int> slots_;      // by place
  std::vector<Body> touched_;   // by place
  std::vector<int> starts_;     // by place, and the end
  std::vector<Entry> entries_;  // by place, in the order of elimination
  std::vector<Vec3> pulls_;     // by row
  std::vector<char> isMet_;     // scratch, by row
};

class Archive;
class Articulation {
 public:
  // `refs` in the table's order; `masses` by BodyId tell which bodies move.
  Articulation(std::span<const JointRef> refs, const Kinds& kinds,
               std::span<const InverseMass> masses, JointTopologies& known);

  std::span<const BodyId> bodies() const { return bodies_; }
  std::size_t size() const { return refs_.size(); }
  std::span<const BodyId> allBodies() const { return all_; }
  bool holdsBothWays() const { return holdsBothWays_; }  // nothing but gaps and axles, at work
  bool givesWay() const { return givesWay_; }            // a spring, drive or damper is at work
  JointResponse& response() { return response_; }        // of bodies that contacts touch
  const JointResponse& response() const { return response_; }
  bool isOpened() const { return isOpened_; }  // a substep since `take` has not closed its joints
  void setOpened(bool opened) { isOpened_ = opened; }
  const JointTopology& topology() const { return *topology_; }
  bool hasLoop() const;  // of bodies, all that do not move being one
  void forget();         // what it pulled with in the last substep
  void archive(Archive& a);

 private:
  template <int W>
  friend class JointPack;
  friend class JointPacks;
  struct Pull {  // of a row, in its last substep
    Vec3 lambda = Vec3::Zero();
    std::array<Vec3, JointRow::kMostBodies> arm{Vec3::Zero(), Vec3::Zero()};
    std::array<Mat3, JointRow::kMostBodies> linear{Mat3::Zero(), Mat3::Zero()};  // but of gaps
  };
  std::uint64_t carryingLimits() const;

  std::shared_ptr<const JointTopology> topology_;
  std::vector<JointRef> refs_;  // in the order of elimination
  std::vector<JointKind> kinds_;
  std::vector<BodyId> all_;     // bodies of its rows, sorted
  std::vector<BodyId> bodies_;  // those of them that move
  std::vector<Pull> pulls_;     // by row
  bool holdsBothWays_ = false, givesWay_ = false, isOpened_ = false;
  JointResponse response_;
};

// What a stage of a substep works on, by BodyId.
struct JointStage {
  Kinds& kinds;
  std::span<Pose> pose;         // trial poses stand here while rows are evaluated
  std::span<const Pose> start;  // of the substep
  double h;
  std::span<const JointMass> masses;
  std::span<Displacement> moved;
  // What bodies turn with on the average of the last substeps [rad/s]: gaps pull along arms that
  // are turned back by h of it. Along those of the substep's end they take omega^2 h of a swing's
  // energy in a second; turned back they take that only of what the steps do not resolve, where the
  // spin is another in each. None: along those of the end.
  std::span<const Vec3> spin = {};
};

// One row of an articulation as it stands, for who solves it together with other rows: no more than
// `rows` of J, by bodies, and alpha.
struct SharedRow {
  int rows = 0;
  std::array<BodyId, JointRow::kMostBodies> bodies{kWorldBody, kWorldBody};  // that move
  std::array<Mat3, JointRow::kMostBodies> linear{Mat3::Zero(), Mat3::Zero()}, angular = linear;
  Mat3 alpha = Mat3::Zero();
};

// Up to W articulations of equal topology, side by side.
template <int W>
class JointPack {
 public:
  void take(std::span<Articulation* const> articulations);
  void stiffen(std::span<Mat3> stiffness);
  void leave(const JointStage& stage, double most, double ofLimits);
  void seeStart(const JointStage& stage);
  bool areNearlyClosed(const JointStage& stage);
  bool findApart(std::span<double> marks) const;
  void forgetClosing(const JointStage& stage, std::span<const Displacement> predicted);
  void seePositions(const JointStage& stage);
  void followPositions(const JointStage& stage);
  void startTurns(const JointStage& stage, const LaneBodies& lanes);
  void followPositions(const LaneBodies& lanes, std::span<const double> wanted);
  void tell(const JointStage& stage) const;
  void closePositions(const JointStage& stage, std::span<const Displacement> predicted);
  void prepareVelocities(const JointStage& stage);
  void solveVelocities(const JointStage& stage);
  void solveVelocities(const LaneBodies& lanes, std::span<const double> wanted);
  void refineVelocities(const JointStage& stage);
  void respond();
  void finish(Kinds& kinds, double h);
  // Of each lane; J and alpha of those that are free, none of the others.
  void addRows(std::vector<SharedRow>& rows) const;

 private:
  struct State {  // of a row that its kind evaluates, by lane
    std::array<JointRow::Role, W> role{};
    std::array<bool, W> active{}, hasStart{};  // its J is the start's
  };
  JointView<W> view();
  bool isApart() const;
  void place(bool back);
  void restorePoses(const JointStage& stage) const;
  void seeOthers(const JointStage& stage, bool all, bool inPositions);
  void seeWays(const JointStage& stage);
  void openAll();
  void open(std::span<const double> wanted);
  bool isNoneOpen() const;
  void solveOpenVelocities();
  void solveOpenVelocities(const JointStage& stage);
  JointContacts contactsOf(const LaneBodies& lanes);
  void followOpen(const LaneBodies& lanes);
  void see(const JointStage& stage, bool first);
  void seeGaps(const JointStage& stage);
  void noteSeen();
  void step();
  void stepToAim();
  void giveUp(const Num<W>& far);
  void leaveOpen(const JointStage& stage, std::span<const Displacement> predicted);
  bool isBeyondLimit(int lane) const;
  bool hasGap(int lane, double most) const;
  double offOf(int lane) const;
  void noteStep(int lane, double off);
  void goBack(int lane, double keeps);
  void goToPredicted(std::span<const Displacement> predicted, int lane);
  bool goBack(const Num<W>& far);
  void giveLoads();
  void chooseFree();
  void setFree(int row, int lane, bool free);
  void factorizeStale();
  bool holdAtBounds();
  void findUsed();
  void takePulls();
  bool givesWay(int row, int lane) const;
  bool holdsBothWays(int lane) const;
  bool hasForce(int lane) const;
  void pushAlone(int lane, JointResponse::Body& touched, std::span<JointResponse::Entry> entries);
  void eliminate(int lane, std::span<JointResponse::Entry> entries);

  int lanes_ = 0;
  std::array<Articulation*, W> of_{};
  std::vector<BodyId> ids_;  // of each lane, body after body
  std::vector<int> slots_;   // theirs in the lanes of contacts; scratch
  std::shared_ptr<const JointTopology> topology_;
  std::vector<JointBody<W>> bodies_;
  std::vector<JointLanes<W>> rows_;
  std::vector<Num<W>> entries_, scaled_;  // of blocks below the diagonal
  std::vector<State> states_;             // by row
  Num<W> open_{}, anew_{};
  std::array<bool, W> apart_{};  // where the step began, and since; or not closed in this substep
  std::array<bool, W> given_{};  // up, by closePositions
  std::vector<char> used_;
  std::vector<int> usedBelow_, usedCounts_;
  std::vector<Num<W>> tail_, tailWork_;  // A, and what it is solved with
  std::vector<char> tailGives_;
  std::vector<int> tailPlaces_;
  int tailCount_ = 0;
  bool tailFactored_ = false;
  std::array<bool, W> stale_{};  // the factor is of other free rows
  bool seenSince_ = true;        // J is not that of the factor any more
  std::array<bool, W> exact_{};  // the factor is that of the velocity stage
  std::vector<JointFactor<W>> factors_;
  std::vector<JointFactored<W>> factored_;
  std::vector<int> entryOf_;  // scratch, by row
  struct {  // where the last step of Newton's began, by row and body, and what it was off by
    std::vector<std::array<Num<W>, 3>> lambda, u, theta;
    std::array<double, W> off{};
  } steps_;
};

// The articulations of a batch.
class JointPacks {
 public:
  void take(std::span<Articulation> articulations, std::span<const int> which);
  void stiffen(std::span<Mat3> stiffness);  // by BodyId: of what joints pull with
  // Before the substep, where errors are taken back by at most so much [m, rad], and this part of
  // those of limits is left.
  void leave(const JointStage& stage, double most, double ofLimits);
  // Joints that are apart where a step begins, or that Newton's steps have not closed: what brings
  // them together is no motion, and bodies go on from what was `predicted` before, and what forces
  // gave them. Marks by BodyId which these are; true: there are some.
  void seeStart(const JointStage& stage);
  bool findApart(std::span<double> marks);
  void forgetClosing(const JointStage& stage, std::span<const Displacement> predicted);
  // Sees them where the bodies are: no gap is more than kNearlyClosed of its arm.
  bool areNearlyClosed(const JointStage& stage);
  // Begins a substep: evaluates the rows where the bodies are. Then, as often as they were given
  // something since, solves for positions by these rows.
  void seePositions(const JointStage& stage);
  void followPositions(const JointStage& stage);
  // The same in turns with contacts, whose lanes have moved since `moved`: from them and into them,
  // to be told in the end. The first turn evaluates the rows, where `moved` has the bodies; the
  // others are of those alone of which `wanted`, by their first body, is more than 0.
  void startTurns(const JointStage& stage, const LaneBodies& lanes);
  void followPositions(const LaneBodies& lanes, std::span<const double> wanted);
  void tell(const JointStage& stage);
  // As often as it takes until what is off before another step is kClosed.
  void closePositions(const JointStage& stage, std::span<const Displacement> predicted);
  // Evaluates at the end of the substep, and solves; then, as often as contacts are swept:
  void startVelocities(const JointStage& stage);
  void solveVelocities(const JointStage& stage);
  void solveVelocities(const LaneBodies& lanes, std::span<const double> wanted);
  void refineVelocities(const JointStage& stage);  // again, where the factor is a former one
  void respond();                                  // of those that ask: `Articulation::response`
  void addRows(std::vector<SharedRow>& rows);      // as they were evaluated last
  // Multipliers back to the kinds' sets, but of those that are opened.
  void finish(Kinds& kinds, double h);

 private:
  void groupAlike(std::vector<Articulation*>& list, std::size_t most);
  template <class F>
  void forEach(F&& f);
  template <int W>
  struct Packs {
    std::vector<JointPack<W>> of;
    std::size_t count = 0;  // of those in use
  };
  std::tuple<Packs<1>, Packs<4>, Packs<8>> packs_;
  std::vector<std::vector<Articulation*>> byTopology_;
  std::vector<std::uint64_t> limits_;  // scratch, of a list
};

}  // namespace physics
