// What the default method keeps and works with. Private to physics/small_steps: one file per part
// of it.
//   divide.cpp        articulations, islands, and the batches that they step in
//   lay_out.cpp       which lanes contacts have
//   contact_rows.cpp  contacts into the lanes that sweep over them, and back
//   responses.cpp     contacts that see what joints make of what they give
//   deep.cpp          overlaps that take more than a few substeps
//   contact_motion.cpp bodies into these lanes, and back
//   body_lanes.cpp    the same of those that contacts alone hold, eight at a time
//   take_turns.cpp    contacts and joints in turns, and that no energy comes of it
//   given.cpp         what contacts give bodies, by an accuracy
//   renew.cpp         rows anew of what has turned far, or goes far past each other
//   substep.cpp       a substep of a batch
//   fly.cpp           bodies that nothing holds, and those that are about to meet
//   accurately.cpp    islands that step by an accuracy, and touch nothing
//   accurately_touching.cpp  and those that touch, or have meshes and ropes
//   put_on_contacts.cpp      what these extrapolate to stays where it touches
//   at_once.cpp       loads of contacts that sweeps do not find
//   close_velocities.cpp     sweeps over their contacts until these change no more
//   bounce.cpp        restitution
//   look.cpp          the contacts of a step
//   again.cpp         steps that joints could not be closed in, with more substeps
//   ask.cpp           how many substeps and sweeps the next step takes
//   learn.cpp         what contacts carry at the start
//   small_steps.cpp   the step
//   island_plan.cpp   what it does with each island, to whoever listens
#pragma once

#include <algorithm>
#include <initializer_list>
#include <map>

#include "physics/accurate/extrapolation.h"
#include "physics/model/model.h"
#include "physics/small_steps/body_block.h"
#include "physics/small_steps/island_plan.h"
#include "physics/small_steps/small_steps.h"
#include "physics/solver/articulation.h"
#include "physics/solver/bisection.h"
#include "physics/solver/contact_block.h"
#include "physics/solver/contact_newton.h"
#include "physics/solver/deformable.h"
#include "physics/solver/soft_rows.h"

namespace physics {

// Groups of blocks that share no body which moves, so that they may be swept at a time.
// `responds`: what they give goes through joints.
struct BlockStage {
  int first = 0, end = 0;  // of the batch's groups
  bool responds = false;
};

// A body of an articulation that responds.
struct Responder {
  int articulation = -1, place = -1;  // and its place in the response
};

// What turns a body. Given: nothing, nor moves it. None: it is a point. Round: in every direction
// the same.
enum class Inertia : char { kGiven, kNone, kRound, kOther };

// Of a body, at the start of its step.
struct KeptStart {
  Pose pose;
  Velocity velocity;
  Vec3 meanSpin = Vec3::Zero();
};

// What pays for being dealt to threads.
constexpr int kLeastBodies = 64, kLeastContacts = 128, kLeastBlocks = 32;

// Substeps at the least, where settings say nothing. Where no joint is, contacts are swept once in
// each, and ropes and meshes are not done after one either; what is light is pressed down for a
// substep before loads that are found at once hold it. Joints are solved in each, with contacts
// swept four times: they need no more than two halves of a step with a look between.
constexpr int kLeastSwept = 4, kLeastSolved = 2, kMostSubsteps = 64;

// Of its weight, what a body may carry while sweeps of its own mass, or turns with joints, find it.
constexpr double kMostCarried = 4;

// In a factor of contacts, a budget of time. Those that take more are swept, whatever they carry.
// Without it 216 cubes under 1 t that fall go 0.1 mm deep, not 57, at 41 ms a step, not 7, and at
// 0.7 s where it hits.
constexpr double kMostMultipliedAtOnce = 3e5;

constexpr double kLargestStrain = 0.02;  // of what holds a mesh, and overlaps of its thickness

constexpr int kByItself = -2;  // of a body's batch: its island has stepped, by an accuracy

// Of what is swept: of ropes, of contacts in islands with joints, at the least where they take
// turns, and of contacts about deep overlaps, where a push finds its way through a column of five
// in that many.
constexpr int kPositionSweeps = 4;

// Contacts are in single precision: of a displacement no less than this part is known.
constexpr double kKnown = 1e-6;

// What contacts of an island know of joints: there are none; no more than each body's own mass, so
// that contacts and joints take turns; the articulated mass of some.
enum class Joined : char { kNot, kTakesTurns, kResponds };

// Of contacts and joints.
struct Turns {
  int least;
  double settled;  // until what one gives is no more than this part of all
};

// Eight numbers, of the lanes of a block.
struct alignas(32) LaneNumbers {
  float of[ContactBlock::kLanes] = {};
};

// What the contacts of a block carry.
struct ContactLoads {
  float point[ContactBlock::kPoints][ContactBlock::kLanes] = {};
  float tangent[2][ContactBlock::kLanes] = {}, twist[ContactBlock::kLanes] = {};
  void takeLane(const ContactBlock& block, int l);
  void giveLane(ContactBlock& block, int l) const;
};
ContactLoads loadsOf(const ContactBlock& block);

// Islands of equal substeps and sweeps, which step side by side.
struct SmallSteps::Batch {
  int substeps = 1, sweeps = 1;
  int positionSweeps = 1, velocitySweeps = 1;  // in the last substep
  bool touches = false;                        // contacts of rigid bodies, in every island of it
  Joined joined = Joined::kNot;                // in every island of it
  bool isDeep = false;                         // it has overlaps that the push speed limits
  bool isAgain = false;   // another attempt of what too few substeps took apart
  bool isLost = false;    // by an accuracy: no step resolves what its islands do
  bool isAtOnce = false;  // one island: Newton's method before the sweeps over its loads
  bool closes = false;    // sweeps go on until contacts are closed, of each of its parts
  std::vector<BodyId> bodies;
  std::vector<int> contacts, articulations, deformables;
  JointPacks joints;                // of these articulations
  std::vector<SoftPair> softPairs;  // what points and links may meet in this step
  std::vector<SoftContact> soft, softBefore;
  std::vector<SoftRow> softRows;
  Contacts impacts;  // with restitution only: the pairs of `contacts`, for one substep
  std::vector<ContactBlock> blocks;
  std::vector<int> groups;            // of blocks, in order: the first of each, and the end
  std::vector<BlockStage> stages;     // of groups, in order
  std::vector<LaneMotion> motions;    // by slot; 0 is what does not move
  std::vector<Responder> responders;  // by slot; empty: none
  std::vector<LaneStart> before;      // of the motions, when the bodies last knew of them
  std::vector<LaneMass> masses;
  std::vector<LaneInverse> inverses;
  std::vector<ContactLoads> told;   // by block: what bodies know of
  std::vector<Displacement> given;  // by slot: impulses, and turns in the units of the lanes
  std::vector<BodyId> slots;        // the body of each slot
  std::vector<KeptStart> kept;      // of `bodies`, where joints may have to make their step again
  std::vector<std::pair<int, int>> sliding;  // blocks and lanes: bodies go far past each other
  std::vector<char> turned;  // by slot: so far that its rows are to be prepared anew
  bool someTurned = false;
  std::vector<BodyBlock> lanes;  // by slot, of what contacts alone hold; empty: it is by itself
  std::vector<int> partOf;       // by slot, where islands step by an accuracy: which of them

  void layNothing();  // there are no contacts
  bool takesTurns() const { return joined == Joined::kTakesTurns; }
  // More than contacts of rigid bodies.
  bool isMixed() const { return !articulations.empty() || isSoft(); }
  bool inLanes() const { return !lanes.empty(); }
  bool isSoft() const { return !deformables.empty() || !softRows.empty(); }
};

// An island that steps by an accuracy and touches or has meshes, on its way through a step of the
// world's.
struct SmallSteps::Trial {
  std::size_t batch = 0;       // its bodies and contacts
  double left = 0, whole = 0;  // of the step; of it, what is tried now [s]
  int most = 0, columns = 0;   // substeps of that in the last row, and rows, where it starts
  int steps = 0;               // substeps of the row that was made last
  bool isLaidOut = false;      // in a batch of its own: lanes are where that has them
  Tableau tableau;
  std::vector<double> levers;                              // by body
  double allowed = 0, extent = 0, error = 0, coarser = 0;  // coarser: by a column less
  int places = 0, changes = 0;  // bodies that err by too much; contacts that its last row changed
  bool isSmooth = true;         // in all rows contacts touch where they did
  bool followsPowers() const { return changes == 0 && isSmooth; }  // of h, does what it errs by
  int flights = 0;
  bool isOneRow = false, needsMore = false;  // it is tried by one row; that did not do
  double oneRowErrs = 0;                     // by what is known of it; infinite: nothing is
  bool isLost = false;   // no step resolved the last one, and the default's is all of this
  bool isRough = false;  // its rows err by no powers of h, or it is lost: taken as it is
  AccuracyReport told;
};

// The slot of a body that moves, of a lane that has a contact.
inline int moverIn(const ContactBlock& block, int l) {
  return block.bodyA[l] > 0 ? block.bodyA[l] : block.bodyB[l];
}

// Rows are prepared where the body is now.
inline void startRows(LaneMotion& motion) {
  for (int k = 0; k < 3; ++k) motion.du[k] = motion.dturn[k] = 0;
}

// Lane l of a block: nothing; or the surfaces of a contact at these poses, without its loads.
void emptyLane(ContactBlock& block, int l);
// `isWithin`: a step, not where it starts and the collider has just looked.
void placeLane(const KeptContact& c, std::span<const Pose> pose, bool isWithin, ContactBlock& block,
               int l);

inline double gravityOf(const Model& w) {  // m/s^2
  return w.settings.gravity ? w.settings.gravity->norm() : 0;
}

// Of an accuracy's step: a force that is constant.
template <class C>
bool isLoad(const Model& w, const C& item) {
  if constexpr (std::is_same_v<C, ConstantForce>) return w.settings.accuracy && !item.factor.table;
  return false;
}

struct SmallSteps::Impl {
  std::vector<KeptContact> contacts, before;  // before: scratch
  std::vector<Articulation> articulations;
  JointTopologies topologies;
  std::vector<Deformable> deformables;
  std::vector<int> articulationOf, deformableOf;  // by body, -1: none
  struct Accurate {
    Extrapolation motion;
    IslandState state;
  };
  std::vector<Accurate> accurate;  // islands without contacts that can step by an accuracy
  std::vector<int> accurateOf;     // by first body of these, -1: none
  std::vector<Pose> trialNow, trialStart, trialEnd;
  std::vector<double> touchedAt;  // by contact of a batch: where it touched, its gap then [m]
  static constexpr int kMostTouchingColumns = 4;  // of 2 at least: one has no estimate
  std::vector<StepChoice> choices;                // by first body of an island that touches
  std::vector<double> oneRowErrs;     // the same: of its size, over a step; infinite: not known
  std::vector<double> missed;         // by body: of the size of its islands
  std::vector<Velocity> accelerated;  // by body of one: in its last step [m/s^2, rad/s^2]
  std::vector<Trial> trials;
  Batch together;  // of some of these
  enum class Ended : char { kFurther, kRejected, kAccepted };
  std::vector<Ended> ends;                      // scratch, of a group
  std::vector<Trial*> pending, waiting, group;  // the same
  struct {                                      // the same, by body of an island
    std::vector<Pose> pose;
    std::vector<Velocity> velocity;
  } reached;
  // A point of contact that carries load, where a step ends.
  struct PressedPoint {
    struct Side {
      BodyId body;
      bool moves;
      Vec3 normal, lever;  // signed
      Displacement way;    // by a unit of push
      double opening(const Vec3& v, const Vec3& w) const { return normal.dot(v) + lever.dot(w); }
    };
    int contact;
    Side sides[2] = {};
    double gap = 0, speed = 0;  // m, m/s: open, and opening
    double gives = 0;           // to a unit of push
  };
  std::vector<PressedPoint> pressedPoints;  // scratch
  // N, by contact and point: of the last row, and of the one before.
  using PointLoads = std::array<double, ContactBlock::kPoints>;
  std::vector<PointLoads> rowLoads, coarserLoads;
  struct Closing {  // of an island: what a sweep has changed, and the largest way [m]
    bool isOpen = true, closesNow = false;
    double change = 0, way = 0;
  };
  std::vector<Closing> closings;
  std::vector<ContactLoads> closedLoads;  // by block, of lanes whose islands are closed, or settled
  std::vector<LaneNumbers> closedChanges;
  double now = 0;                     // s, where what is stepped next starts
  std::vector<LaneMotion> swept;      // by slot: after the last sweep
  std::vector<LaneStart> turnsStart;  // by slot: before contacts and joints take turns
  std::vector<double> turns;          // by body: 1 where its island takes another
  bool known = false;                 // these are those of the world's constraints
  std::vector<int> substeps, sweeps;  // by body: of the last step, and what the next one asks for
  std::vector<int> asked, askedSweeps;
  // Loads that sweeps do not find, and islands that may have such; by the first body.
  std::vector<char> askedAtOnce, atOnce, uneven, hangs;
  std::vector<SubstepLaw> law;  // by body: what it asks for `asked` by
  std::vector<Batch> batches;
  std::size_t batchCount = 0;
  Islands islands;
  std::vector<int> batchOf, slotOf;  // by body
  Bisection bisection;               // of the batch that is laid out, as what follows
  struct Place {                     // of a contact; 0: it moves nothing there
    int slotA = 0, slotB = 0, stage = 0, group = 0, colour = 0, sort = 0, points = 1;
  };
  std::vector<Place> places;
  std::vector<int> inGroup, groupEnd;       // contacts of the batch, by group
  std::vector<std::uint64_t> colours;       // by stage and slot: taken by contacts
  std::vector<std::uint64_t> groupColours;  // by group
  std::vector<int> firstOf;                 // by group, colour and sort: a lane
  std::vector<char> responding;             // by articulation: contacts see its mass
  std::vector<int> finer;          // by articulation: substeps that its joints ask for, 0: none
  std::vector<char> opened;        // of an island with joints, by its first body: they came apart
  std::vector<Inertia> inertiaOf;  // by body, of this step
  std::vector<double> length;      // by body: of its substep [s], one for all of an island
  std::vector<JointMass> masses;
  std::vector<Displacement> moved;
  std::vector<Mat3> stiffness;
  std::vector<Mat3> inertias;   // world, at X^t, and the turn without joints and contacts: of those
  std::vector<Vec3> spins;      // whose inertia turns with them
  std::vector<Vec3> meanSpins;  // by body: what turns arms back [rad/s]
  std::vector<double> radius, thickness;  // by body, of its shape
  std::vector<Vec3> pushed;               // by body: what hits add to its way in this step [m]
  std::vector<double> push;               // and how far that is
  std::vector<double> flung;              // by articulation: how far hits may fling its bodies [m]
  std::vector<char> sliding;              // by contact: far in this step; empty: none does
  enum class Held : char { kNot, kJoined, kTouching };  // by joints or points; by contacts
  std::vector<Held> held;                               // of an island, by its first body
  std::vector<Joined> joined;                           // the same
  std::vector<char> deforms;                            // the same: it has meshes or ropes
  // By body (island: by its first).
  std::vector<double> load, sag, drawn, carried, weight;
  std::vector<double> energy, whole, change, changeBefore;
  std::vector<double> articulatedMass;        // of all bodies of an articulation [kg]
  std::vector<SharedRow> sharedRows;          // scratch
  std::vector<LaneStart> atOnceBefore;        // scratch, by slot
  ContactNewton newton;                       // of the batch that steps
  std::vector<Displacement> predicted;        // by body: before joints and contacts
  std::vector<LaneNumbers> works;             // scratch, by block
  std::vector<std::pair<int, int>> overlaps;  // scratch, by slots
  std::vector<int> forApproach;               // the same, by contact: substeps

  void learn(Model& w);
  void learnAccurate(Model& w, const std::vector<std::vector<JointRef>>& rows);
  static void takeForces(Model& w);
  void advanceAccurately(Model& w, AccuracyReport& report);
  bool advanceAccurately(Model& w, BodyId root, double dt, AccuracyReport& report);
  bool stepsAccurately(const Model& w, const Batch& batch) const;
  double allowedError(const Model& w) const;
  double meshesClose(const Model& w) const;
  void advanceTouching(Model& w, StepReport& report);
  bool isAlike(const Model& w, const Trial& a, const Trial& b) const;
  void fly(Model& w, Trial& trial);
  bool plan(Model& w, Trial& trial);
  void tryTogether(Model& w, std::vector<Trial*>& group, StepReport& report);
  Batch& lanesFor(Model& w, std::span<Trial* const> group);
  void addRow(Model& w, std::span<Trial* const> group, Batch& batch, int steps, StepReport& report);
  void addRow(const Model& w, Trial& trial);
  void close(Model& w, Deformable& mesh, double h);
  double wayAhead(const Model& w, const Trial& trial) const;
  double wayOf(const Model& w, const Trial& trial) const;
  bool mayTakeOneRow(const Model& w, const Trial& trial) const;
  static Velocity accelerationOf(const Bodies& b, const Batch& batch, std::size_t k, double time);
  double errorOfOneRow(const Model& w, const Trial& trial) const;
  void noteMotion(const Model& w, const Trial& trial);
  bool isDone(Model& w, Trial& trial);
  bool goesOn(const Model& w, Trial& trial);
  void conclude(Model& w, std::vector<Trial*>& group, Batch& batch);
  void finish(const Model& w, const Trial& trial, AccuracyReport& report);
  void countChanges(std::span<Trial* const> group, const Batch& batch) const;
  template <class F>
  static void forEachPart(const Batch& batch, F&& f);
  void measureChanges(const Batch& batch);
  void watchVelocities(const Batch& batch);
  void closeVelocities(Model& w, Batch& batch);
  bool closeParts(const Model& w, const Batch& batch);
  void keepClosed(const Batch& batch);
  void takeClosed(Batch& batch) const;
  bool givesExactly(const Model& w, const Batch& batch) const;
  void startGiving(const Model& w, Batch& batch);
  void noteGiven(const Model& w, Batch& batch);
  bool giveExactly(const Model& w, Batch& batch);
  static void giveLane(Batch& batch, const ContactBlock& block, const ContactLoads& told, int lane);
  double sizeOf(const Bodies& b, const Batch& batch) const;
  double missedBy(const Batch& batch) const;
  void miss(const Batch& batch, double error);
  void begin(const Model& w, Trial& trial);
  void noteLoads(const Model& w, const Batch& batch);
  void holdLoads(const Model& w, const Trial& trial);
  bool opensAtEnd(const Bodies& b, const Batch& batch);
  bool goToReached(Model& w, Batch& batch, double h);
  void takeBest(Model& w, const Trial& trial);
  void putOnContacts(Model& w, const Batch& batch, double most);
  PressedPoint pressedPoint(const Bodies& b, int contact, int point) const;
  void seeRocking();
  void takeBack(const Batch& batch, double PressedPoint::*open);
  void goBack(Bodies& b, const Batch& batch);
  void goBack(Bodies& b, const Batch& batch, std::size_t k);
  void run(Model& w, Batch& batch, double h, int count, StepReport& report);
  void runSubsteps(Model& w, Batch& batch, double h, int count, StepReport& report);
  void makeRoom(std::size_t bodies);
  void look(Model& w);
  bool lookOnce(Model& w);
  void renewFound(std::span<const Found> found, const Bodies& bodies);
  bool findPushes(Model& w);
  Vec3 wayInStep(const Model& w, const KeptContact& c) const;
  double ownSide(const KeptContact& c) const;
  bool goesFar(const Model& w, const KeptContact& c) const;
  void findSliding(Model& w);
  void noteSliding(Batch& batch) const;
  bool findFeatures(const Model& w, const KeptContact& c, Manifold& found) const;
  bool lookAtSliding(const Model& w, ContactBlock& block, int l);
  void lookAtSliding(Model& w, Batch& batch);
  void renewRows(Model& w, Batch& batch);
  int leastOf(const Model& w, BodyId i) const;
  void divide(Model& w);
  int substepsForApproach(const Model& w, const KeptContact& c) const;
  double lightMass(const Bodies& b, const KeptContact& c) const;
  bool isOverloaded(const Model& w, const Batch& batch) const;
  void layAtOnce(Batch& batch);
  void takeJoints(Batch& batch);
  template <class F>
  void solveAtOnce(Batch& batch, F&& solve);
  void solvePositionsAtOnce(Batch& batch, PositionSweep which);
  void solveVelocitiesAtOnce(Batch& batch);
  static bool isHit(const Model& w, const KeptContact& c);
  void assign(Model& w);
  void assign(const Model& w, BodyId i);
  Batch& batchFor(const Model& w, BodyId root);
  Place placeOf(const Bodies& b, int contact, int levels) const;
  static int colourOf(const Place& place, std::uint64_t* taken);
  template <class F>
  static void forEachPlanned(Model& w, int levels, F&& f);
  void groupContacts(Model& w, const Batch& batch, int levels);
  int countLanes(Batch& batch, int levels);
  BodyId leaderOf(BodyId i) const;
  bool meetsResponse(const KeptContact& c) const;
  void takeSlots(Model& w, Batch& batch, int levels);
  void forgetResponses(Batch& batch);
  void takeResponses(Batch& batch);
  void respond(Batch& batch);
  void prepareResponses(Batch& batch, ContactBlock& block, int lane) const;
  LaneStart lookAtResponse(Batch& batch, int slot) const;
  void lookAtResponses(Batch& batch) const;
  void respondTo(const Batch& batch, int slot, const LaneStart& before);
  void weighJoints(const Model& w, const Batch& batch);
  template <class F>
  void sweepResponding(Batch& batch, ContactBlock& block, F&& kernel);
  template <class F>
  static void forEachGroup(Model& w, const Batch& batch, const BlockStage& stage, F&& f);
  template <class F>
  static void forEachGroup(Model& w, const Batch& batch, F&& f);
  template <class F>
  static void forEachBody(Model& w, const Batch& batch, F&& f);
  template <class F>
  void sweep(Model& w, Batch& batch, std::initializer_list<ContactRows> responding, F&& kernel);
  void layOut(Model& w, Batch& batch);
  BodyId softMoverOf(const Model& w, const SoftPair& pair) const;
  void joinSoft(const Model& w, const SoftPair& pair);
  void assignSoft(Model& w);
  bool lookSoft(Model& w);
  void gatherSoft(Model& w);
  void lookAgain(Model& w, Batch& batch, double h);
  void predict(Model& w, Batch& batch, bool first);
  bool isHalved(const Batch& batch, BodyId i) const;
  void giveOtherHalf(const Model& w, const Batch& batch, double h);
  void predictBody(Model& w, const Batch& batch, BodyId i, bool first);
  void predictTurn(Model& w, BodyId i, double h, double kick);
  void takeMass(const Model& w, BodyId i);
  template <class F>
  static void forEachBodyBlock(Model& w, Batch& batch, F&& f);
  void startBody(const Model& w, BodyId i, BodyBlock& b, int l) const;
  void pushBody(Model& w, BodyId i, BodyBlock& b, int l) const;
  void predictLanes(Model& w, Batch& batch, bool first);
  static void giveLanes(Model& w, Batch& batch);
  static void displaceLanes(Model& w, Batch& batch);
  static void endLanes(Model& w, Batch& batch);
  static void takeRoot(Batch& batch, int slot);
  void tellBody(const Batch& batch, int slot);
  static void seeBody(Batch& batch, int slot);
  LaneBodies lanesOf(Batch& batch) const;
  void toLane(Batch& batch, int slot);
  void fromLane(Batch& batch, int slot);
  void takeGiven(Batch& batch, int slot);
  void toLanes(Model& w, Batch& batch);
  void fromLanes(Model& w, Batch& batch);
  void warmStartContacts(Model& w, Batch& batch);
  void sweepContactPositions(Model& w, Batch& batch, PositionSweep which);
  void sweepContactVelocities(Model& w, Batch& batch, VelocitySweep which);
  void sweepContactVelocities(Model& w, Batch& batch, int s);
  void tellBodies(Model& w, Batch& batch, const JointStage& stage);
  void balanceContacts(Model& w, Batch& batch);
  void displaceBody(Model& w, BodyId i);
  void displaceAll(Model& w, Batch& batch);
  Vec3 spinAtEnd(const Bodies& b, BodyId i) const;
  void forgetClosing(Model& w, Batch& batch, double h);
  template <class F>
  static void forEachLane(const Batch& batch, F&& f);
  void noteApproach(Model& w, Batch& batch, double h);
  void bounce(Model& w, Batch& batch, double h);
  void passOn(Model& w, Batch& batch, double h);
  void solveContactPositions(Model& w, Batch& batch, const JointStage& stage);
  void takeTurns(Model& w, Batch& batch, const JointStage& stage);
  bool limitGuess(Model& w, Batch& batch);
  bool findShares(const Batch& batch);
  template <class Contacts, class Joints>
  int turnUntilSettled(Batch& batch, const Turns& of, Contacts&& contacts, Joints&& joints);
  void turnVelocities(Model& w, Batch& batch, const JointStage& stage);
  void weighTurn(const Batch& batch);
  bool findUnsettled(const Batch& batch, double settled);
  bool keepSettled(const Batch& batch);
  void takeSettled(Batch& batch) const;
  void addWork(const Batch& batch, std::vector<double>& work);
  static void takeBack(Batch& batch, ContactBlock& block, const LaneNumbers& parts);
  template <class Part>
  void takeParts(Model& w, Batch& batch, Part&& partOf);
  void takeShares(Model& w, Batch& batch);
  void forgetLoads(Model& w, Batch& batch);
  double closingShare(const Model& w, BodyId root) const;
  void solvePositions(Model& w, Batch& batch, double h);
  void sweepDeformables(Model& w, Batch& batch, double h);
  void solveVelocities(Model& w, Batch& batch, double h);
  void sweepSoft(Batch& batch);
  void takeVelocities(Model& w, Batch& batch);
  void substep(Model& w, Batch& batch, double h, StepReport& report);
  bool findTurned(Model& w, Batch& batch) const;
  bool turnsNormal(const ContactBlock& block, int l, const std::vector<LaneMotion>& motions,
                   double far) const;
  FrictionAt frictionAt(const Model& w, const Batch& batch) const;
  void renew(const Model& w, const Batch& batch, ContactBlock& block) const;
  void renewTurned(Model& w, Batch& batch);
  void takeOver(Model& w, Batch& batch);
  static void holdNoMore(KeptContact& c, double carried);  // N
  void holdCarried(const Model& w, const Batch& batch, double h);
  void takeOver(const Model& w, const ContactBlock& block, int l, double whole);
  double sagOf(BodyId root) const;
  double sagOfColumn(BodyId root) const;
  void weighMotion(const Model& w, const Batch& batch);
  struct Weighed {  // a contact, of what its island is weighed by
    BodyId root = kWorldBody;
    double change = 0, changeBefore = 0, motion = 0, way = 0, seen = 0, sag = 0, drawn = 0,
           carried = 0;
  };
  std::vector<std::array<Weighed, ContactBlock::kLanes>> weighed;  // scratch, by block
  Weighed weigh(const Model& w, const Batch& batch, const ContactBlock& block, int l) const;
  void weighContacts(Model& w, const Batch& batch);
  bool asksAtOnce(const Model& w, const Batch& batch, BodyId root) const;
  void askJoints(const Model& w, const Batch& batch);
  void askSoft(const Model& w, const Batch& batch);
  void askDeformables(Model& w, const Batch& batch);
  void keepStart(const Model& w, Batch& batch);
  bool isOpened(const Batch& batch) const;
  bool makesFiner(Bodies& b, Batch& batch);
  bool findOpened(const Batch& batch);
  void moveTo(Model& w, Batch& batch, Batch& again);
  void makeAgain(Model& w, std::size_t index);
  void askFiner(const Model& w, const Batch& batch);
  int takenBy(const Model& w, BodyId i) const;
  void want(BodyId body, int count, SubstepLaw by);
  void ask(Model& w, const Batch& batch);
  void fly(Model& w);
  void fly(const Model& w, BodyId i, double dt, Pose& pose, Velocity& v) const;
  double gapAtTrial(const Bodies& b, const KeptContact& c);
  bool presses(const Model& w, const KeptContact& c, double moment);
  bool mayFly(const Model& w, const Batch& batch, double time);
  double gapAfter(const Model& w, const Batch& batch, double time);
  double bendOf(const Model& w, const Batch& batch) const;
  double flyToTouch(Model& w, const Batch& batch, double most);
  bool meets(const Model& w, const Batch& batch, double time);
  bool hit(Model& w, Batch& batch, double time);
  void rest(const Batch& batch);
  void unload(const Batch& batch);
  void finish(Model& w, Batch& batch, double h);
  void advance(Model& w, StepReport& report);
  void learnLoads(Model& w);
  void tell(const Model& w) const;
  void countParts(const Batch& batch, std::map<BodyId, IslandPlan>& plans) const;
  void learnNormalLoads(Batch& batch);
  void learnLoads(Model& w, Batch& batch);
  template <typename Visit>
  void forEachLane(const Model& w, Batch& batch, Visit&& visit);
  bool isBalanced(const Model& w, Batch& batch, int sweeps);
  const std::function<void()>* wake = nullptr;  // of the present step
  bool fresh = true;      // nothing has stepped yet, or the state came from elsewhere
  bool learning = false;  // what contacts carry: they do not give way, nor push
  struct LoadRound {      // then, by block: what it carried at the last look, and changed by
    ContactLoads told, change;
  };
  std::vector<LoadRound> learnt;
  struct IslandRound {  // then, by its first body: of its loads since the last look
    float most = 0, largest = 0;
    bool isAlone = false, isSettled = false;
  };
  std::vector<IslandRound> rounds;
  void goAhead(const Model& w, Batch& batch);
  BodyId rootOf(const Model& w, const KeptContact& c) const;
  BodyId rootOf(const Batch& batch, const ContactBlock& block, int lane) const;
  double lengthOf(const Bodies& b, const KeptContact& c) const;
  bool isJointed(const KeptContact& c) const;
  double sagOfWay(const Model& w, const KeptContact& c, double size) const;
  Softness softnessOf(const Bodies& b, const Batch& batch, const KeptContact& c) const;
  void takeSlots(const Bodies& b, ContactBlock& block, int l) const;
  void fill(const Model& w, const Batch& batch, ContactBlock& block) const;
  void rows(Model& w, Batch& batch);
  bool isDeep(const Batch& batch, std::span<const ContactBlock> blocks) const;
  template <class F>
  void forEachDeep(const Batch& batch, std::span<const ContactBlock> blocks, F&& f) const;
  void noteDeep(Batch& batch);
  std::vector<SoftPair> softPairs;
  std::vector<SoftContact> gathered;  // scratch, and its order
  std::vector<int> gatherOrder;
  std::vector<BodyId> free;
};

// What contacts give to bodies of articulations is taken from these alone, and goes to all of an
// articulation.
template <class F>
void SmallSteps::Impl::sweepResponding(Batch& batch, ContactBlock& block, F&& kernel) {
  constexpr int kLanes = ContactBlock::kLanes;
  LaneStart before[2 * kLanes];
  const auto forEachResponder = [&](auto&& f) {
    for (int l = 0; l < 2 * kLanes; ++l) {
      const int slot = l < kLanes ? block.bodyA[l] : block.bodyB[l - kLanes];
      if (batch.responders[slot].articulation >= 0) f(slot, before[l]);
    }
  };
  forEachResponder([&](int slot, LaneStart& start) { start = lookAtResponse(batch, slot); });
  kernel(&block, 1);
  forEachResponder([&](int slot, const LaneStart& start) { respondTo(batch, slot, start); });
}

// f(from, to) of the blocks of groups, dealt to threads where that pays.
template <class F>
void SmallSteps::Impl::forEachGroup(Model& w, const Batch& batch, const BlockStage& stage, F&& f) {
  const int* const starts = &batch.groups[stage.first];
  const int count = stage.end - stage.first;
  const bool pays = starts[count] - starts[0] >= kLeastBlocks;
  w.workers.forEachChunk(count, pays ? 1 : count,
                         [&](int from, int to) { f(starts[from], starts[to]); });
}

// The same of all blocks, by what depends on no other: dealt as sweeps deal them, lines of the
// cache stay where they are.
template <class F>
void SmallSteps::Impl::forEachGroup(Model& w, const Batch& batch, F&& f) {
  for (const BlockStage& stage : batch.stages) forEachGroup(w, batch, stage, f);
}

// f(body, slot) of all, dealt to threads as their contacts are. Slots are theirs where there are
// contacts.
template <class F>
void SmallSteps::Impl::forEachBody(Model& w, const Batch& batch, F&& f) {
  const BodyId* const bodies =
      batch.contacts.empty() ? batch.bodies.data() : batch.slots.data() + 1;
  w.workers.forEachChunk(static_cast<int>(batch.bodies.size()), kLeastBodies,
                         [&](int from, int to) {
                           for (int k = from; k < to; ++k) f(bodies[k], k + 1);
                         });
}

// kernel(blocks, count, rows) of what may be swept at a time, in order. Where joints respond the
// rows are swept by parts: each sees what the one before has made of the articulation.
template <class F>
void SmallSteps::Impl::sweep(Model& w, Batch& batch, std::initializer_list<ContactRows> responding,
                             F&& kernel) {
  ContactBlock* const blocks = batch.blocks.data();
  for (const BlockStage& stage : batch.stages) {
    if (stage.responds) {
      for (int k = batch.groups[stage.first]; k < batch.groups[stage.end]; ++k) {
        for (const ContactRows rows : responding) {
          sweepResponding(batch, blocks[k],
                          [&](ContactBlock* b, int count) { kernel(b, count, rows); });
        }
      }
    } else {
      forEachGroup(w, batch, stage,
                   [&](int from, int to) { kernel(blocks + from, to - from, ContactRows::kAll); });
    }
  }
}

// f(block, lane, place of the contact in batch.contacts) of every lane that has a contact.
template <class F>
void SmallSteps::Impl::forEachLane(const Batch& batch, F&& f) {
  for (const ContactBlock& block : batch.blocks) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      const auto found =
          std::lower_bound(batch.contacts.begin(), batch.contacts.end(), block.contact[l]);
      f(block, l, static_cast<int>(found - batch.contacts.begin()));
    }
  }
}

// f(block, lane, place of its island in the batch) of every lane that has a contact.
template <class F>
void SmallSteps::Impl::forEachPart(const Batch& batch, F&& f) {
  for (std::size_t i = 0; i < batch.blocks.size(); ++i) {
    const ContactBlock& block = batch.blocks[i];
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      f(i, l, batch.partOf[moverIn(block, l)]);
    }
  }
}

}  // namespace physics
