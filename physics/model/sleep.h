// Who sleeps. When a body does, and what wakes it: effects/sleep.h.
#pragma once

#include <vector>

#include "physics/constraints/contact.h"

namespace physics {

struct Sleep {
  std::vector<int> still;             // by body: steps in a row that it was slow
  std::vector<char> asleep;           // by body
  std::vector<BodyId> island;         // by body: the first of the island that it fell asleep with
  std::vector<BodyId> called;         // to be woken before the next step
  std::vector<ContactPair> contacts;  // of bodies that sleep; sorted
  int count = 0;                      // of those that sleep
};

// Its island steps again, from the next step on.
inline void callAwake(Sleep& sleep, BodyId body) {
  if (sleep.count > 0 && sleep.asleep[body]) sleep.called.push_back(body);
  if (!sleep.still.empty()) sleep.still[body] = 0;
}

}  // namespace physics
