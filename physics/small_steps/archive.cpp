// What the next step reads of the small steps before it writes it.
#include "physics/solver/archive.h"

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

// Islands, batches and rows are made in every step; articulations and ropes follow from the
// model's constraints, and ropes go on from the multipliers that stand there.
void SmallSteps::archive(Archive& a, Model& w) {
  Impl& i = *impl_;
  bool knows = i.known;
  std::size_t bodies = i.choices.size();
  a(knows, bodies);
  if (a.reads()) {
    i.known = false;
    i.makeRoom(bodies);
    if (knows) i.learn(w);
  }
  a(i.contacts, sleeping, i.fresh, i.substeps, i.sweeps, i.asked, i.askedSweeps, i.askedAtOnce,
    i.law, i.meanSpins, i.oneRowErrs, i.missed, i.accelerated);
  for (StepChoice& choice : i.choices) a(choice);
  if (!knows) return;  // what is not known is made anew
  a(i.responding, i.finer);
  for (Articulation& articulation : i.articulations) a(articulation);
  for (Impl::Accurate& island : i.accurate) a(island.motion);
  if (!a.reads()) return;
  for (Deformable& deformable : i.deformables) deformable.goOn(w.kinds);
}

}  // namespace physics
