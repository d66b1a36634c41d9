// Sweeps over contacts in AVX-512 registers, two blocks of a colour at a time and others in AVX2:
// compiled with -mavx512f, called where the processor has it.
#include "physics/solver/contact_kernels.h"

namespace physics {
namespace {

// two(block, points) of a block and the next, where they share no body and have as many points;
// one(block) of the others.
template <class Two, class One>
inline void forEachTwo(ContactBlock* blocks, int count, Two&& two, One&& one) {
  const auto goTogether = [](const ContactBlock& a, const ContactBlock& b) {
    return a.colour >= 0 && a.colour == b.colour && a.points == b.points;
  };
  for (int i = 0; i < count; ++i) {
    if (i + 1 < count && goTogether(blocks[i], blocks[i + 1])) {
      forEachBlock(blocks + i++, 1, two);
    } else {
      one(blocks[i]);
    }
  }
}

void warmStartTwo(ContactBlock* blocks, int count, LaneMotion* motions) {
  forEachTwo(
      blocks, count,
      [&](ContactBlock& block, auto points) { warmStartBlock<points.value>(block, motions); },
      [&](ContactBlock& block) { kContactKernelsAvx2.warmStart(&block, 1, motions); });
}
void sweepPositionsTwo(ContactBlock* blocks, int count, LaneMotion* motions, PositionSweep which) {
  forEachTwo(
      blocks, count,
      [&](ContactBlock& block, auto points) {
        sweepPositionsBlock<points.value>(block, motions, which);
      },
      [&](ContactBlock& block) { kContactKernelsAvx2.sweepPositions(&block, 1, motions, which); });
}
void sweepVelocitiesTwo(ContactBlock* blocks, int count, LaneMotion* motions, VelocitySweep which) {
  forEachTwo(
      blocks, count,
      [&](ContactBlock& block, auto points) {
        sweepVelocitiesBlock<points.value>(block, motions, which);
      },
      [&](ContactBlock& block) { kContactKernelsAvx2.sweepVelocities(&block, 1, motions, which); });
}

}  // namespace

const ContactSweeps kContactSweepsAvx512 = {warmStartTwo, sweepPositionsTwo, sweepVelocitiesTwo};

}  // namespace physics
