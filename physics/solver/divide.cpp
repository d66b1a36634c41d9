// What steps together: articulations by constraints, islands by contacts as well, batches of
// islands with as many substeps.
#include <algorithm>

#include "physics/solver/small_steps_impl.h"

namespace physics {
void SmallSteps::clear(Batch& batch) {
  batch.bodies.clear();
  batch.contacts.clear();
  batch.articulations.clear();
  batch.blocks.clear();
  batch.motions.clear();
  batch.masses.clear();
  batch.slots.clear();
}

// Bodies that constraints join make an articulation.
void SmallSteps::Impl::learn(World::Impl& w) {
  makeRoom(w.bodies.pose.size());
  if (known && articulationOf.size() == w.bodies.pose.size()) return;
  known = true;
  const Islands& joined = jointIslands(w);
  std::vector<std::vector<Articulation::Ref>> rows(joined.size());
  std::vector<BodyId> roots;
  int place = 0;
  forEachKind(w.kinds, [&](const auto& kind) {
    for (std::size_t k = 0; k < kind.set.items.size(); ++k) {
      const BodyId mover = moverOf(kind.set.items[k], w.bodies);
      if (mover == kWorldBody) continue;
      auto& list = rows[joined[mover]];
      if (list.empty()) roots.push_back(joined[mover]);
      list.push_back({place, static_cast<int>(k)});
    }
    ++place;
  });
  std::sort(roots.begin(), roots.end());
  articulations.clear();
  articulationOf.assign(w.bodies.pose.size(), -1);
  for (const BodyId root : roots) {
    for (const BodyId body :
         articulations.emplace_back(rows[root], w.kinds, w.bodies.inverse).bodies()) {
      articulationOf[body] = static_cast<int>(articulations.size()) - 1;
    }
  }
}

SmallSteps::Batch& SmallSteps::Impl::batchFor(int count, int sweepCount) {
  for (std::size_t k = 0; k < batchCount; ++k) {
    if (batches[k].substeps == count && batches[k].sweeps == sweepCount) return batches[k];
  }
  if (batchCount == batches.size()) batches.emplace_back();
  Batch& batch = batches[batchCount++];
  clear(batch);
  batch.substeps = count;
  batch.sweeps = sweepCount;
  return batch;
}

// Islands by constraints and contacts, and the batch that each steps with.
void SmallSteps::Impl::divide(World::Impl& w) {
  const Bodies& b = w.bodies;
  islands = jointIslands(w);
  for (const KeptContact& c : contacts) join(b, islands, c.a, c.b);
  settle(islands, b.active);
  for (const BodyId i : b.active) {
    batchOf[i] = -1;
    energy[i] = 0;  // bodies of the island that something holds
    substeps[i] = std::max(1, w.settings.substeps);
    sweeps[i] = 1;
  }
  for (const BodyId i : b.active) {
    const BodyId root = islands[i];
    substeps[root] = std::max(substeps[root], asked[i]);
    sweeps[root] = std::max(sweeps[root], askedSweeps[i]);
    if (articulationOf[i] >= 0) energy[root] = 1;
  }
  for (const KeptContact& c : contacts) {
    energy[islands[isMovable(b, c.a) ? c.a : c.b]] = 1;
  }
  batchCount = 0;
  free.clear();
  for (const BodyId i : b.active) {
    const BodyId root = islands[i];
    if (energy[root] == 0) {
      free.push_back(i);
      continue;
    }
    if (batchOf[root] < 0) {
      batchOf[root] = static_cast<int>(&batchFor(substeps[root], sweeps[root]) - batches.data());
    }
    batchOf[i] = batchOf[root];
    substeps[i] = substeps[root];
    batches[batchOf[i]].bodies.push_back(i);
    const int articulation = articulationOf[i];
    if (articulation >= 0 && articulations[articulation].bodies().front() == i) {
      batches[batchOf[i]].articulations.push_back(articulation);
    }
  }
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const BodyId body = isMovable(b, contacts[k].a) ? contacts[k].a : contacts[k].b;
    batches[batchOf[body]].contacts.push_back(static_cast<int>(k));
  }
}

}  // namespace physics
