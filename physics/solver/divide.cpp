// What steps together: articulations by constraints, islands by contacts as well, batches of
// islands with as many substeps.
#include <algorithm>

#include "physics/solver/small_steps_impl.h"

namespace physics {
namespace {

// The end of a point or link that moves.
BodyId moverOf(const SoftElement& element, const Bodies& bodies) {
  return isMovable(bodies, element.from) ? element.from : element.to;
}

}  // namespace

void SmallSteps::clear(Batch& batch) {
  batch.bodies.clear();
  batch.contacts.clear();
  batch.articulations.clear();
  batch.deformables.clear();
  batch.softPairs.clear();
  batch.soft.clear();
  batch.blocks.clear();
  batch.motions.clear();
  batch.masses.clear();
  batch.slots.clear();
}

// Bodies that constraints join make an articulation; points, and what has a factor that would fill
// up, a deformable.
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
  deformables.clear();
  articulationOf.assign(w.bodies.pose.size(), -1);
  deformableOf.assign(w.bodies.pose.size(), -1);
  for (const BodyId root : roots) {
    const Mesh mesh = meshOf(rows[root], w.kinds, w.bodies.inverse);
    const bool isDirect = mesh.fill <= kMostFill;
    if (mesh.points || !isDirect) {
      deformables.emplace_back(rows[root], w.kinds, w.bodies.inverse, isDirect);
      for (const BodyId i : deformables.back().bodies())
        deformableOf[i] = static_cast<int>(deformables.size()) - 1;
    } else {
      articulations.emplace_back(rows[root], w.kinds, w.bodies.inverse);
      for (const BodyId i : articulations.back().bodies())
        articulationOf[i] = static_cast<int>(articulations.size()) - 1;
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
  for (const SoftPair& pair : softPairs) {
    const SoftElement& element = w.softCollider.element(pair.element);
    join(b, islands, element.from, element.to);
    join(b, islands, moverOf(element, b), pair.body);
  }
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
    if (articulationOf[i] >= 0 || deformableOf[i] >= 0) energy[root] = 1;
  }
  for (const KeptContact& c : contacts) {
    energy[islands[isMovable(b, c.a) ? c.a : c.b]] = 1;
  }
  for (const SoftPair& pair : softPairs) {
    energy[islands[moverOf(w.softCollider.element(pair.element), b)]] = 1;
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
    const int deformable = deformableOf[i];
    if (deformable >= 0 && deformables[deformable].bodies().front() == i) {
      batches[batchOf[i]].deformables.push_back(deformable);
    }
  }
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const BodyId body = isMovable(b, contacts[k].a) ? contacts[k].a : contacts[k].b;
    batches[batchOf[body]].contacts.push_back(static_cast<int>(k));
  }
  for (const SoftPair& pair : softPairs) {
    const BodyId mover = moverOf(w.softCollider.element(pair.element), b);
    batches[batchOf[mover]].softPairs.push_back(pair);
  }
  for (const SoftContact& c : w.softContacts) {
    const BodyId body = isMovable(b, c.from) ? c.from : c.to;
    if (batchOf[body] >= 0) batches[batchOf[body]].soft.push_back(c);
  }
}

}  // namespace physics
