// What happened where two runs part: the contact that began or ended, or the impact.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/trust/difference.h"

namespace app {

struct TrustEvent {
  enum class Kind { kBegan, kEnded, kJolt };  // a contact; a velocity that jumps between frames
  Kind kind = Kind::kBegan;
  int frame = 0;
  physics::BodyId a = 0, b = 0;          // a jolt: b is 0
  bool inFirst = true, inSecond = true;  // which of the runs it happened in, in that frame
};

// How the body came apart: from a tenth of what it is allowed to the first frame beyond it.
struct Growth {
  int from = 0, to = 0;                   // frames
  double distance = 0, fromDistance = 0;  // m, at `to` and at `from`
  double rate = 0;                        // 1/s: distance goes with exp(rate t) on the mean
};
Growth growthOf(const Track& a, const Track& b, physics::BodyId body, const Allowed& allowed,
                int beyond);

// Of the events of what the body is joined to, while it came apart, the one at which the velocities
// of the two runs came apart by most. None: nothing touched it or left it, and nothing jolted it.
std::optional<TrustEvent> findEvent(const Track& a, const Track& b,
                                    const std::vector<Allowed>& allowed, physics::BodyId body,
                                    const Growth& growth);

}  // namespace app
