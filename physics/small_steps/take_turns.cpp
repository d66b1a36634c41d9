// Contacts in turns with the joints, where they see no more than bodies' own masses: positions, and
// velocities; and that what they begin with is no energy.
#include <algorithm>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// Turns of contacts and joints: so many at the least, and on until what the contacts of an island
// give in one is no more than this part of what its bodies have been given in all, in the norm of
// their masses. Each contact sees a limb alone, and what lies behind it pushes that on. An overlap
// that is left is taken back in the next substep. Figures that fall on a foot at 2 to 14 m/s go in
// by 0.9 mm on the average and 10 at the most where four are all, by 0.6 and 4.9 so, and thirty in
// a bowl by 23 and 17; with one at the least, what lies never rests: after eleven seconds 33 of 48
// figures move faster than 1 mm/s, not 18.
constexpr Turns kOfPositions = {kPositionSweeps, 0.1};
// A speed that is left goes on: after a single turn those on a foot go in by 5.3 and 23 mm, until a
// tenth by 0.7 and 5.1, and those in the bowl by 33 and 24. A hundred that lie take 3 % more time
// with a hundredth than with a tenth.
constexpr Turns kOfVelocities = {1, 0.01};
// Of the velocity stages of a hundred that fall and lie a third ends so. With 64 those on a foot go
// in by 0.5 and 3.1 mm, those in a bowl no less, and these take twice the time while they fall.
constexpr int kMostTurns = 16;

float squared(const float (&now)[3], const float (&then)[3]) {
  const float x = now[0] - then[0], y = now[1] - then[1], z = now[2] - then[2];
  return x * x + y * y + z * z;
}

void scale(ContactBlock& block, const LaneNumbers& by) {
  for (int l = 0; l < ContactBlock::kLanes; ++l) {
    for (int k = 0; k < block.points; ++k) block.point[k].lambda[l] *= by.of[l];
    for (auto& t : block.tangent) t.lambda[l] *= by.of[l];
    block.twist[l] *= by.of[l];
  }
}

}  // namespace

// Contacts alone, in the lanes: colour by colour.
void SmallSteps::Impl::warmStartContacts(Model& w, Batch& batch) {
  sweep(w, batch, {ContactRows::kAll}, [&](ContactBlock* blocks, int count, ContactRows) {
    contactKernels().warmStart(blocks, count, batch.motions.data());
  });
}

void SmallSteps::Impl::sweepContactPositions(Model& w, Batch& batch, PositionSweep which) {
  sweep(w, batch, {ContactRows::kAll}, [&](ContactBlock* blocks, int count, ContactRows) {
    contactKernels().sweepPositions(blocks, count, batch.motions.data(), which);
  });
}

// Joints know what contacts carry before these are swept: by its own mass alone, a foot that bears
// its figure would fly up under that, and the sweep would take all of it back. For the same reason
// the rows of joints are those of before: evaluated where the foot has flown to, they open. Where
// they take turns, springs carry more than their bodies weigh, and are drawn far: substeps do not
// follow that, as they do where bodies are single. Until they are done only the lanes know what
// bodies without joints move by. Islands have each their own last turn: what sweeps over the others
// change in them is taken back, so that none of them feels the others.
void SmallSteps::Impl::takeTurns(Model& w, Batch& batch, const JointStage& stage) {
  const PositionSweep which = {.isDrawnByLoad = true};
  for (const BodyId i : batch.bodies) turns[i] = 1;
  toLanes(w, batch);
  turnsStart = batch.before;
  if (!batch.isAtOnce) addWork(batch, load);
  warmStartContacts(w, batch);
  batch.joints.startTurns(stage, lanesOf(batch));
  for (const BodyId i : batch.bodies) predicted[i] = moved[i];
  if (batch.isAtOnce) {
    solvePositionsAtOnce(batch, which);
    batch.joints.followPositions(lanesOf(batch), turns);
  } else {
    addWork(batch, carried);
    if (limitGuess(w, batch)) batch.joints.followPositions(lanesOf(batch), change);
  }
  const auto contacts = [&](int) { sweepContactPositions(w, batch, which); };
  const auto joints = [&] { batch.joints.followPositions(lanesOf(batch), turns); };
  batch.positionSweeps = turnUntilSettled(batch, kOfPositions, contacts, joints);
  tellBodies(w, batch, stage);
}

// From where all are unsettled. Returns how many it took.
template <class Contacts, class Joints>
int SmallSteps::Impl::turnUntilSettled(Batch& batch, const Turns& of, Contacts&& contacts,
                                       Joints&& joints) {
  bool goOn = true;
  int s = 0;
  for (; s < kMostTurns && goOn; ++s) {
    profileScope("contact");
    const bool someSettled = s >= of.least && keepSettled(batch), mayEnd = s + 1 >= of.least;
    if (mayEnd) swept = batch.motions;
    contacts(s);
    if (someSettled) takeSettled(batch);
    if (mayEnd) weighTurn(batch);
    profileScope("direct");
    joints();
    if (mayEnd) goOn = findUnsettled(batch, of.settled);
  }
  return s;
}

// Loads that bodies rest by are learnt in as many turns as are made for that.
void SmallSteps::Impl::turnVelocities(Model& w, Batch& batch, const JointStage& stage) {
  for (const BodyId i : batch.bodies) turns[i] = 1;
  const auto joints = [&] {
    if (!batch.isSoft()) return batch.joints.solveVelocities(lanesOf(batch), turns);
    fromLanes(w, batch);
    sweepSoft(batch);
    batch.joints.solveVelocities(stage);
    toLanes(w, batch);
  };
  if (learning) {
    for (int s = 0; s < batch.sweeps; ++s) {
      balanceContacts(w, batch);
      joints();
    }
    return tellBodies(w, batch, stage);
  }
  if (batch.isAtOnce) {
    solveVelocitiesAtOnce(batch);
    joints();
  }
  const auto contacts = [&](int s) { sweepContactVelocities(w, batch, {.first = s == 0}); };
  batch.velocitySweeps = turnUntilSettled(batch, kOfVelocities, contacts, joints);
  tellBodies(w, batch, stage);
}

// Contacts begin with what they carried before, and joints with what follows from it: that gives
// s lambda^T J u0 + s^2 lambda^T J (u1 - u0) / 2 of energy. Where all of it gives some it is no
// load that lasts but what a hit has left, and islands begin with the part of it that leaves the
// least. Without, five of 300 figures that fall on a foot gain 1 to 3 % of what they fall with in a
// frame. True: there are some, and joints are to follow. Loads that are found at once need no
// guess.
bool SmallSteps::Impl::limitGuess(Model& w, Batch& batch) {
  const bool some = findShares(batch);
  if (some) takeShares(w, batch);
  return some;
}

// Of islands, by their first body, that gain energy by lambda, whose lambda^T J u is `load` before
// and `carried` after: `change` becomes the share 1 + u0 / (u1 - u0) of it that is too much, else
// 0. True: there is some.
bool SmallSteps::Impl::findShares(const Batch& batch) {
  bool some = false;
  for (const BodyId i : batch.bodies) {
    const double before = load[i], more = carried[i] - load[i];
    const bool rises = islands[i] == i && before + carried[i] > 0 && more > 0;
    change[i] = rises ? std::clamp(1 + before / more, 0.0, 1.0) : 0;
    some = some || change[i] > 0;
  }
  return some;
}

// Of islands that are not settled, by their first body: what the last sweep gave, and all that
// joints and contacts have given since the turns began.
void SmallSteps::Impl::weighTurn(const Batch& batch) {
  std::vector<double>&given = load, &all = whole;
  for (const BodyId i : batch.bodies) given[i] = all[i] = 0;
  for (std::size_t s = 1; s < batch.motions.size(); ++s) {
    const BodyId root = islands[batch.slots[s]];
    const float inverse = batch.masses[s].inverse;
    if (!(turns[root] > 0) || !(inverse > 0)) continue;
    const double mass = 1 / double(inverse);
    const LaneMotion &now = batch.motions[s], &then = swept[s];
    const LaneStart& start = turnsStart[s];
    given[root] += mass * squared(now.u, then.u) + squared(now.turn, then.turn);
    all[root] += mass * squared(now.u, start.u) + squared(now.turn, start.turn);
  }
}

// True: there are some, for which `turns` stays 1.
bool SmallSteps::Impl::findUnsettled(const Batch& batch, double settled) {
  const std::vector<double>&given = load, &all = whole;
  bool some = false;
  for (const BodyId i : batch.bodies) {
    const BodyId root = islands[i];
    turns[i] = turns[i] > 0 && given[root] > settled * settled * all[root] ? 1 : 0;
    some = some || turns[i] > 0;
  }
  return some;
}

// What the lanes of islands that are settled carry; their motions are `swept`. True: there are
// some.
bool SmallSteps::Impl::keepSettled(const Batch& batch) {
  const auto isSettled = [this](BodyId i) { return !(turns[i] > 0); };
  if (std::none_of(batch.bodies.begin(), batch.bodies.end(), isSettled)) return false;
  closedLoads.resize(batch.blocks.size());
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) closedLoads[k] = loadsOf(batch.blocks[k]);
  return true;
}

void SmallSteps::Impl::takeSettled(Batch& batch) const {
  for (std::size_t s = 1; s < batch.motions.size(); ++s) {
    if (!(turns[batch.slots[s]] > 0)) batch.motions[s] = swept[s];
  }
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) {
    ContactBlock& block = batch.blocks[k];
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0 || turns[rootOf(batch, block, l)] > 0) continue;
      closedLoads[k].giveLane(block, l);
    }
  }
}

// What turns ended with.
void SmallSteps::Impl::tellBodies(Model& w, Batch& batch, const JointStage& stage) {
  fromLanes(w, batch);
  batch.joints.tell(stage);
}

// Of contacts that have no turns to take: they see what joints make of what they give, or there are
// none.
void SmallSteps::Impl::solveContactPositions(Model& w, Batch& batch, const JointStage& stage) {
  profileScope("contact");
  if (!batch.inLanes()) toLanes(w, batch);
  respond(batch);
  startGiving(w, batch);
  const bool isGuessed = batch.joined == Joined::kResponds && !batch.isAtOnce;
  if (isGuessed) addWork(batch, load);
  warmStartContacts(w, batch);
  if (isGuessed) {
    lookAtResponses(batch);
    addWork(batch, carried);
    limitGuess(w, batch);
  }
  PositionSweep which;
  solvePositionsAtOnce(batch, which);
  const bool isJointed = batch.joined != Joined::kNot;
  const int sweeps = batch.isDeep || isJointed ? kPositionSweeps : 1;
  for (int s = 0; s < sweeps; ++s) {
    which.onlyDeep = s > 0 && !isJointed;
    sweepContactPositions(w, batch, which);
  }
  if (batch.isMixed()) fromLanes(w, batch);
  batch.joints.followPositions(stage);
}

// lambda^T J u of islands, by their first body, for what the lanes move by.
void SmallSteps::Impl::addWork(const Batch& batch, std::vector<double>& work) {
  works.resize(batch.blocks.size());
  contactKernels().measureWork(batch.blocks.data(), static_cast<int>(batch.blocks.size()),
                               batch.motions.data(), works.data()->of);
  for (const BodyId i : batch.bodies) work[i] = 0;
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) {
    const ContactBlock& block = batch.blocks[k];
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] >= 0) work[rootOf(batch, block, l)] += works[k].of[l];
    }
  }
}

// These parts of what the lanes of a block carry, from it and from its bodies.
void SmallSteps::Impl::takeBack(Batch& batch, ContactBlock& block, const LaneNumbers& parts) {
  ContactBlock back = block;
  LaneNumbers less, left;
  for (int l = 0; l < ContactBlock::kLanes; ++l) {
    less.of[l] = -parts.of[l];
    left.of[l] = 1 - parts.of[l];
  }
  scale(back, less);
  scale(block, left);
  contactKernels().give(&back, 1, batch.motions.data());
}

// So much of what each lane gave, in 0..1.
template <class Part>
void SmallSteps::Impl::takeParts(Model& w, Batch& batch, Part&& partOf) {
  sweep(w, batch, {ContactRows::kAll}, [&](ContactBlock* blocks, int count, ContactRows) {
    for (ContactBlock& block : std::span(blocks, count)) {
      LaneNumbers parts;
      bool some = false;
      for (int l = 0; l < ContactBlock::kLanes; ++l) {
        if (block.contact[l] < 0) continue;
        parts.of[l] = static_cast<float>(partOf(block, l));
        some = some || parts.of[l] > 0;
      }
      if (some) takeBack(batch, block, parts);
    }
  });
}

// Of islands with a share, by their first body; `change` is that of all their bodies from then on.
void SmallSteps::Impl::takeShares(Model& w, Batch& batch) {
  for (const BodyId i : batch.bodies) change[i] = change[islands[i]];
  takeParts(w, batch,
            [&](const ContactBlock& block, int l) { return change[rootOf(batch, block, l)]; });
}

// What contacts of bodies that are apart (their `change` is 1) gave, from both sides.
void SmallSteps::Impl::forgetLoads(Model& w, Batch& batch) {
  const auto isMarked = [&](BodyId i) { return articulationOf[i] >= 0 && change[i] > 0; };
  takeParts(w, batch, [&](const ContactBlock& block, int l) {
    const KeptContact& c = contacts[block.contact[l]];
    return isMarked(c.a) || isMarked(c.b) ? 1 : 0;
  });
  fromLanes(w, batch);
}

}  // namespace physics
