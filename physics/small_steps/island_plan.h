// What the default method does with each island of a step, told to whoever listens.
#pragma once

#include <functional>

#include "physics/base/types.h"

namespace physics {

// What an island's substeps are asked for by, ask.cpp: nothing more than the settings' least; the
// sag of contacts under their load; the overlap of points and links; the strain of what holds a
// mesh; the turn of a rope's pieces; the speed at which bodies approach each other (divide.cpp);
// joints that half as many substeps could not close (again.cpp).
enum class SubstepLaw : char { kLeast, kSag, kOverlap, kStrain, kTurn, kApproach, kOpened };

struct IslandPlan {
  BodyId first = 0;  // of its bodies
  int bodies = 0;
  bool flies = false;            // nothing holds it: one body, exactly, in one go
  int trees = 0, loops = 0;      // of joints, limits, forces: each solved at once
  int joints = 0;                // constraints in those
  int ropes = 0, meshes = 0;     // of points: solved at once, swept
  int links = 0;                 // constraints in those
  int contacts = 0;              // pairs of bodies that meet or may
  int softContacts = 0;          // points and links that may meet a body
  int substeps = 0, sweeps = 0;  // a step, a substep
  SubstepLaw law = SubstepLaw::kLeast;
  bool halves = false;  // fast: it looks for contacts twice a step
};

// What steps on this thread tell while it lives: every island, twice where it goes in halves.
class IslandListening {
 public:
  using Listener = std::function<void(const IslandPlan&)>;
  explicit IslandListening(Listener listener);
  ~IslandListening();
  IslandListening(const IslandListening&) = delete;
  IslandListening& operator=(const IslandListening&) = delete;
  static const Listener* present();  // null: nobody listens

 private:
  Listener listener_;
  const Listener* before_;
};

}  // namespace physics
