// What the default method keeps and works with. Private to physics/solver: one file per part of it.
//   divide.cpp        articulations, islands, and the batches that they step in
//   contact_rows.cpp  contacts into the lanes that sweep over them, and back
//   substep.cpp       a substep of a batch
//   fly.cpp           bodies that nothing holds
//   small_steps.cpp   the step, and how many substeps it takes
#pragma once

#include "physics/islands.h"
#include "physics/solver/articulation.h"
#include "physics/solver/contact_block.h"
#include "physics/solver/small_steps.h"
#include "physics/world_impl.h"

namespace physics {

// Islands of equal substeps and sweeps, which step side by side.
struct SmallSteps::Batch {
  int substeps = 1, sweeps = 1;
  std::vector<BodyId> bodies;
  std::vector<int> contacts, articulations;
  std::vector<ContactBlock> blocks;
  std::vector<LaneMotion> motions;  // by slot; 0 is what does not move
  std::vector<LaneMass> masses;
  std::vector<BodyId> slots;  // the body of each slot
};

struct SmallSteps::Impl {
  std::vector<KeptContact> contacts, before;
  std::vector<Articulation> articulations;
  std::vector<int> articulationOf;    // by body, -1: none
  bool known = false;                 // articulations are those of the world's constraints
  std::vector<int> substeps, sweeps;  // by body: of the last step, and what the next one asks for
  std::vector<int> asked, askedSweeps;
  std::vector<Batch> batches;
  std::size_t batchCount = 0;
  Islands islands;
  std::vector<int> batchOf, slotOf;                  // by body
  std::vector<std::uint64_t> colours, coloursFixed;  // by body: taken by its contacts
  std::vector<std::vector<int>> byColour;
  std::vector<JointMass> masses;
  std::vector<Displacement> moved;
  std::vector<Mat3> stiffness;
  std::vector<double> load, sag, energy, change;  // by body (of islands by their first)

  void learn(World::Impl& w);
  void makeRoom(std::size_t bodies);
  bool look(World::Impl& w, double dt);
  bool closesBy(const World::Impl& w, double dt, double far);
  void divide(World::Impl& w);
  Batch& batchFor(int substeps, int sweeps);
  void layOut(World::Impl& w, Batch& batch);
  void predict(World::Impl& w, Batch& batch, double h);
  void toLanes(Batch& batch);
  void fromLanes(Batch& batch);
  void displaceAll(World::Impl& w, Batch& batch, double h);
  void substep(World::Impl& w, Batch& batch, double h, StepReport& report);
  void takeOver(Batch& batch, double h);
  void ask(World::Impl& w, Batch& batch, double h);
  void fly(World::Impl& w, double dt);
  void advance(World::Impl& w, StepReport& report);
  void learnLoads(World::Impl& w);
  bool fresh = true;  // nothing has stepped yet, or the state came from elsewhere
  void rows(World::Impl& w, Batch& batch, double h);
  std::vector<BodyId> free;
  std::vector<Displacement> lanesBefore;
};

}  // namespace physics
