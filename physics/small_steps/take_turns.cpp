// Positions of contacts, in turns with the joints where they see no more than bodies' own masses;
// and that what they give to islands with joints is no energy.
#include <algorithm>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

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
// bodies without joints move by.
void SmallSteps::Impl::takeTurns(Model& w, Batch& batch, const JointStage& stage) {
  const PositionSweep which = {.isDrawnByLoad = true};
  toLanes(w, batch);
  warmStartContacts(w, batch);
  batch.joints.startTurns(stage, lanesOf(batch));
  for (const BodyId i : batch.bodies) predicted[i] = moved[i];
  if (batch.isAtOnce) {
    solvePositionsAtOnce(batch, which);
    batch.joints.followPositions(lanesOf(batch));
  }
  for (int s = 0; s < kPositionSweeps; ++s) {
    profileScope("contact");
    sweepContactPositions(w, batch, which);
    profileScope("direct");
    batch.joints.followPositions(lanesOf(batch));
  }
  tellBodies(w, batch, stage);
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
  warmStartContacts(w, batch);
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
void SmallSteps::Impl::addWork(const Model& w, const Batch& batch, std::vector<double>& work) {
  works.resize(batch.blocks.size());
  contactKernels().measureWork(batch.blocks.data(), static_cast<int>(batch.blocks.size()),
                               batch.motions.data(), works.data()->of);
  for (const BodyId i : batch.bodies) work[i] = 0;
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) {
    const ContactBlock& block = batch.blocks[k];
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      work[rootOf(w, contacts[block.contact[l]])] += works[k].of[l];
    }
  }
}

// Contacts and friction give lambda^T J (u0 + u1) / 2 of energy, from what was predicted to what
// the velocity stage ends with. Where that is more than nothing, `change` becomes the share of
// lambda which is too much, if that is less than it was: with s lambda it is s lambda^T J u0 +
// s^2 lambda^T J (u1 - u0) / 2. Of islands, by their first body. True: there is some.
bool SmallSteps::Impl::findRise(Model& w, Batch& batch) {
  swapPredicted(batch);
  toLanes(w, batch);
  addWork(w, batch, load);
  swapPredicted(batch);
  toLanes(w, batch);
  addWork(w, batch, carried);
  bool some = false;
  for (const BodyId i : batch.bodies) {
    const double before = load[i], more = carried[i] - load[i];
    const bool rises = islands[i] == i && before + carried[i] > 0 && more > 0;
    change[i] = rises ? std::clamp(1 + 2 * before / more, 0.0, change[i]) : 0;
    some = some || change[i] > 0;
  }
  return some;
}

// Of islands with a share, what joints alone make of what was predicted: planks that hang and
// crates that stand on them fall alike without, and what parts them by the least would be all that
// contacts do.
void SmallSteps::Impl::holdPredicted(Batch& batch, const JointStage& stage) {
  for (const BodyId i : batch.bodies) change[i] = change[islands[i]];
  swapPredicted(batch);
  batch.joints.holdVelocities(stage, change);
  swapPredicted(batch);
}

void SmallSteps::Impl::swapPredicted(const Batch& batch) {
  for (const BodyId i : batch.bodies) std::swap(moved[i], predicted[i]);
}

// These shares of what the lanes of a block carry, from it and from its bodies.
void SmallSteps::Impl::takeBack(Batch& batch, ContactBlock& block, const LaneNumbers& shares) {
  ContactBlock back = block;
  for (int l = 0; l < ContactBlock::kLanes; ++l) {
    const auto scale = [l](ContactBlock& of, float by) {
      for (int k = 0; k < of.points; ++k) of.point[k].lambda[l] *= by;
      for (auto& t : of.tangent) t.lambda[l] *= by;
      of.twist[l] *= by;
    };
    scale(back, -shares.of[l]);
    scale(block, 1 - shares.of[l]);
  }
  contactKernels().give(&back, 1, batch.motions.data());
}

// What contacts of bodies that are apart (their `change` is 1) gave, from both sides.
void SmallSteps::Impl::forgetLoads(Model& w, Batch& batch) {
  const auto isMarked = [&](BodyId i) { return articulationOf[i] >= 0 && change[i] > 0; };
  for (ContactBlock& block : batch.blocks) {
    LaneNumbers shares;
    bool some = false;
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      const KeptContact& c = contacts[block.contact[l]];
      if (!isMarked(c.a) && !isMarked(c.b)) continue;
      shares.of[l] = 1;
      some = true;
    }
    if (some) takeBack(batch, block, shares);
  }
  fromLanes(w, batch);
}

// Contacts take back by a body's own mass what they gave too much, but joints pass on to the others
// most of what it was given: what a hit leaves behind would throw figures. Joints of the other
// islands stay as they are.
void SmallSteps::Impl::boundWork(Model& w, Batch& batch, const JointStage& stage) {
  for (const BodyId i : batch.bodies) change[i] = 1;
  if (!findRise(w, batch)) return;
  holdPredicted(batch, stage);
  if (!findRise(w, batch)) return;
  for (ContactBlock& block : batch.blocks) {
    LaneNumbers shares;
    bool some = false;
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      const double share = change[rootOf(w, contacts[block.contact[l]])];
      shares.of[l] = static_cast<float>(share);
      some = some || share > 0;
    }
    if (some) takeBack(batch, block, shares);
  }
  fromLanes(w, batch);
  for (const BodyId i : batch.bodies) change[i] = change[islands[i]];
  batch.joints.solveVelocities(stage, change);
}

}  // namespace physics
