// Sweeps over the contacts of islands that step by an accuracy, until they change velocities by no
// more than is asked. Islands in one batch have each their own end: what sweeps change after it is
// taken back, so that none of them feels the others.
#include <algorithm>
#include <cmath>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

double square(double x) { return x * x; }

}  // namespace

// Of islands that are open: what the last sweep has changed, and the largest way [m], of points of
// bodies in this substep.
void SmallSteps::Impl::measureChanges(const Batch& batch) {
  for (std::size_t s = 1; s < batch.motions.size(); ++s) {
    Closing& of = closings[batch.partOf[s]];
    if (!of.isOpen) continue;
    const LaneMotion& now = batch.motions[s];
    double du = 0, dturn = 0, u = 0, turn = 0;
    for (int k = 0; k < 3; ++k) {
      du += square(now.u[k] - swept[s].u[k]);
      dturn += square(now.turn[k] - swept[s].turn[k]);
      u += square(now.u[k]);
      turn += square(now.turn[k]);
      swept[s].u[k] = now.u[k];
      swept[s].turn[k] = now.turn[k];
    }
    const double arm = radius[batch.slots[s]];
    of.change = std::max(of.change, std::sqrt(du) + arm * std::sqrt(dturn));
    of.way = std::max(of.way, std::sqrt(u) + arm * std::sqrt(turn));
  }
}

// What the next sweep over contacts alone may be the last one after, where it changes no more.
void SmallSteps::Impl::watchVelocities(const Batch& batch) {
  swept.resize(batch.motions.size());
  std::fill(closings.begin(), closings.end(), Closing{});
  measureChanges(batch);
}

// Which islands the last sweep closed. True: none is left open.
bool SmallSteps::Impl::closeParts(const Model& w, const Batch& batch) {
  const double g = gravityOf(w);
  for (std::size_t s = 1; s < batch.motions.size(); ++s) {
    Closing& of = closings[batch.partOf[s]];
    if (!of.isOpen) continue;
    of.change = 0;
    of.way = square(length[batch.slots[s]]) * g;
  }
  measureChanges(batch);
  const double allowed = allowedError(w);
  bool isDone = true;
  for (Closing& of : closings) {
    of.closesNow = of.isOpen && of.change <= allowed * of.way;
    if (of.closesNow) of.isOpen = false;
    isDone = isDone && !of.isOpen;
  }
  return isDone;
}

// What the lanes of islands that close now carry; their motions are `swept`.
void SmallSteps::Impl::keepClosed(const Batch& batch) {
  closedLoads.resize(batch.blocks.size());
  closedChanges.resize(batch.blocks.size());
  forEachPart(batch, [&](std::size_t i, int l, int part) {
    if (!closings[part].closesNow) return;
    closedLoads[i].takeLane(batch.blocks[i], l);
    closedChanges[i].of[l] = batch.blocks[i].change[0][l];
  });
}

// Islands that sweeps have gone on over since they were closed are where they were then.
void SmallSteps::Impl::takeClosed(Batch& batch) const {
  const auto isKept = [&](int part) { return !closings[part].isOpen && !closings[part].closesNow; };
  for (std::size_t s = 1; s < batch.motions.size(); ++s) {
    if (!isKept(batch.partOf[s])) continue;
    std::copy_n(swept[s].u, 3, batch.motions[s].u);
    std::copy_n(swept[s].turn, 3, batch.motions[s].turn);
  }
  forEachPart(batch, [&](std::size_t i, int l, int part) {
    if (!isKept(part)) return;
    closedLoads[i].giveLane(batch.blocks[i], l);
    batch.blocks[i].change[0][l] = closedChanges[i].of[l];
  });
}

void SmallSteps::Impl::closeVelocities(Model& w, Batch& batch) {
  constexpr int kMost = 16;  // what has not settled by then the estimate tells
  bool isDone = closeParts(w, batch), isKept = false;
  for (int s = 0; s < kMost && !isDone; ++s) {
    const bool closed = std::any_of(closings.begin(), closings.end(),
                                    [](const Closing& of) { return of.closesNow; });
    if (closed) keepClosed(batch);
    for (Closing& of : closings) of.closesNow = false;
    isKept = isKept || closed;
    sweepContactVelocities(w, batch, {.left = 0});
    if (s + 1 < kMost) isDone = closeParts(w, batch);
  }
  if (isKept) takeClosed(batch);
}

}  // namespace physics
