// The kernels of contact_block.h as a table, which KERNELS names, for the two files that compile
// it.
#include "physics/solver/contact_kernels.h"
#include "physics/solver/contact_prepare.h"

namespace physics {
namespace {

void prepareAll(ContactBlock* blocks, int count, const LaneMass* masses, FrictionAt friction) {
  for (int i = 0; i < count; ++i) prepareBlock(blocks[i], masses, friction);
}
void warmStartAll(ContactBlock* blocks, int count, LaneMotion* motions) {
  forEachBlock(blocks, count, [&](ContactBlock& block, auto points) {
    warmStartBlock<points.value>(block, motions);
  });
}
void giveAll(const ContactBlock* blocks, int count, LaneMotion* motions) {
  forEachBlock(blocks, count, [&](const ContactBlock& block, auto points) {
    giveBlock<points.value>(block, motions);
  });
}
void measureWorkAll(const ContactBlock* blocks, int count, const LaneMotion* motions, float* work) {
  forEachBlock(blocks, count, [&](const ContactBlock& block, auto points) {
    store(work + (&block - blocks) * ContactBlock::kLanes, workOf<points.value>(block, motions));
  });
}
void sweepPositionsAll(ContactBlock* blocks, int count, LaneMotion* motions, PositionSweep which) {
  forEachBlock(blocks, count, [&](ContactBlock& block, auto points) {
    sweepPositionsBlock<points.value>(block, motions, which);
  });
}
void sweepVelocitiesAll(ContactBlock* blocks, int count, LaneMotion* motions, VelocitySweep which) {
  forEachBlock(blocks, count, [&](ContactBlock& block, auto points) {
    sweepVelocitiesBlock<points.value>(block, motions, which);
  });
}

void findAimsAll(const ContactBlock* blocks, int count, const LaneMotion* motions,
                 PositionSweep which, PositionAims* aims) {
  forEachBlock(blocks, count, [&](const ContactBlock& block, auto points) {
    aimBlock<points.value>(block, motions, which, aims[&block - blocks]);
  });
}

void measureAll(ContactBlock* blocks, int count, const LaneMotion* motions) {
  forEachBlock(blocks, count, [&](ContactBlock& block, auto points) {
    measureBlock<points.value>(block, motions);
  });
}

void balanceAll(ContactBlock* blocks, int count, LaneMotion* motions) {
  forEachBlock(blocks, count, [&](ContactBlock& block, auto points) {
    balanceBlock<points.value>(block, motions);
  });
}

}  // namespace

const ContactKernels KERNELS = {{warmStartAll, sweepPositionsAll, sweepVelocitiesAll},
                                prepareAll,
                                giveAll,
                                measureWorkAll,
                                findAimsAll,
                                measureAll,
                                balanceAll};

}  // namespace physics
