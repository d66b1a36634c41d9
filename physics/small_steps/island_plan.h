// What the default method does with each island of a step, told to whoever listens.
#pragma once

#include <functional>
#include <utility>

#include "physics/base/types.h"
#include "physics/model/report.h"

namespace physics {

// What an island's substeps are asked for by, ask.cpp: nothing more than the settings' least; the
// sag of contacts under their load; the overlap of points and links; the strain of what holds a
// mesh; the turn of a rope's pieces; how quickly what joints pull turns back; the speed at which
// bodies approach each other (divide.cpp); joints that half as many substeps could not close
// (again.cpp).
enum class SubstepLaw : char { kLeast, kSag, kOverlap, kStrain, kTurn, kPull, kApproach, kOpened };

struct IslandPlan {
  BodyId first = 0;  // of its bodies
  int bodies = 0;
  bool flies = false;        // nothing holds it: one body, exactly, in one go
  int trees = 0, loops = 0;  // of joints, limits, forces: each solved at once
  int joints = 0;            // constraints in those
  // Of points: solved at once; their links at once and the rest swept; swept.
  int ropes = 0, cloths = 0, meshes = 0;
  int links = 0;                 // constraints in those
  int contacts = 0;              // pairs of bodies that meet or may
  bool atOnce = false;           // of these the loads by Newton's method
  int softContacts = 0;          // points and links that may meet a body
  int substeps = 0, sweeps = 0;  // a step, a substep
  SubstepLaw law = SubstepLaw::kLeast;
};

// How an island came through its step by an accuracy.
struct IslandSteps {
  BodyId first = 0;      // of its bodies
  int bodies = 0;        // that move
  double time = 0;       // that it advanced by [s]
  double size = 0;       // that the accuracy is relative to [m]
  double tolerance = 0;  // one of its steps may err by this part of the size
  AccuracyReport steps;
};

// What steps on this thread tell while it lives: every island.
template <class Told>
class IslandsHeard {
 public:
  using Listener = std::function<void(const Told&)>;
  explicit IslandsHeard(Listener listener)
      : listener_(std::move(listener)), before_(std::exchange(present_, &listener_)) {}
  ~IslandsHeard() { present_ = before_; }
  IslandsHeard(const IslandsHeard&) = delete;
  IslandsHeard& operator=(const IslandsHeard&) = delete;

  static bool isHeard() { return present_ != nullptr; }
  static void tell(const Told& told) {
    if (present_ != nullptr) (*present_)(told);
  }

 private:
  static inline thread_local const Listener* present_ = nullptr;
  Listener listener_;
  const Listener* before_;
};
using IslandListening = IslandsHeard<IslandPlan>;
using StepListening = IslandsHeard<IslandSteps>;

}  // namespace physics
