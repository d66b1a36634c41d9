// Overlaps that are taken back more slowly than springs would: those that the push speed limits.
#include <algorithm>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// f(block, lane, overlap of its deepest point) of what overlaps.
template <class F>
void forEachOverlap(std::span<const ContactBlock> blocks, F&& f) {
  for (const ContactBlock& block : blocks) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      float depth = 0;
      for (int k = 0; k < block.points; ++k) {
        depth = std::max(depth, -(block.gap[k][l] + block.drawn[k][l]));
      }
      if (depth > 0) f(block, l, depth);
    }
  }
}

}  // namespace

// Whether the push speed limits any of these.
bool SmallSteps::Impl::isDeep(const Batch& batch, std::span<const ContactBlock> blocks) const {
  bool some = false;
  forEachDeep(batch, blocks, [&](const ContactBlock&, int, float) { some = true; });
  return some;
}

template <class F>
void SmallSteps::Impl::forEachDeep(const Batch& batch, std::span<const ContactBlock> blocks,
                                   F&& f) const {
  const auto isJointed = [&](int slot) { return articulationOf[batch.slots[slot]] >= 0; };
  forEachOverlap(blocks, [&](const ContactBlock& block, int l, float depth) {
    if (!(block.scale[l] * block.rate[l] * depth > block.push[l])) return;
    if (!isJointed(block.bodyA[l]) && !isJointed(block.bodyB[l])) f(block, l, depth);
  });
}

// The deepest of these at every body and at those around it that a substep's pushes reach. Were all
// of them pushed alike, a crowd could balance with the one inside the other: around the deepest the
// others are pushed in proportion to their depth, which is how springs unpack. Figures come apart
// as their joints let them, in turns with these.
void SmallSteps::Impl::noteDeep(Batch& batch) {
  forEachDeep(batch, batch.blocks, [&](const ContactBlock& block, int l, float depth) {
    for (const int slot : {block.bodyA[l], block.bodyB[l]}) {
      if (slot > 0) batch.motions[slot].own = std::max(batch.motions[slot].own, depth);
    }
  });
  for (LaneMotion& motion : batch.motions) motion.deepest = motion.own;
  overlaps.clear();
  forEachOverlap(batch.blocks, [&](const ContactBlock& block, int l, float) {
    if (block.bodyA[l] > 0 && block.bodyB[l] > 0) {
      overlaps.emplace_back(block.bodyA[l], block.bodyB[l]);
    }
  });
  for (int ring = 0; ring < kPositionSweeps; ++ring) {
    for (const auto& [slotA, slotB] : overlaps) {
      LaneMotion &a = batch.motions[slotA], &b = batch.motions[slotB];
      a.deepest = std::max(a.deepest, b.own);
      b.deepest = std::max(b.deepest, a.own);
    }
    for (LaneMotion& motion : batch.motions) motion.own = motion.deepest;
  }
}

}  // namespace physics
