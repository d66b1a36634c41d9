// Tells who measures which scope a step is in. Physics reads no clock: the listener may.
#pragma once

#include <functional>

namespace physics {

// The scopes that steps on this thread enter, while it lives: the word of a kind of constraint, or
// one of
//   arm          inverse kinematics
//   motion       free motion: gravity, loads, turning
//   inertia      world inertias that follow their bodies
//   broad_phase, narrow_phase, contact, soft_contact, restitution
//   direct       the rows of all joints, and their solution at once
//   schemes      what second-order stepping needs beside the free motion
//   sleep, local_substeps   who rests, and how many substeps each island takes
//   rival        a whole substep of another method
//   ""           the rest: velocities, checks, bookkeeping
class Listening {
 public:
  using Listener = std::function<void(const char* work)>;
  explicit Listening(Listener listener);
  ~Listening();
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

 private:
  Listener listener_;
  const Listener* before_;
};

// Nothing but a look where nobody listens; never called from an inner loop.
void profileScope(const char* work);

}  // namespace physics
