// Articulations, and which of them step side by side.
#include "physics/solver/articulation.h"

#include <algorithm>
#include <bit>
#include <set>

#include "physics/base/archive.h"

namespace physics {

Articulation::Articulation(std::span<const JointRef> refs, const Kinds& kinds,
                           std::span<const InverseMass> masses, JointTopologies& known) {
  std::vector<JointKind> rows;
  for (const JointRef ref : refs) {
    const JointKind& kind = rows.emplace_back(kindOf(kinds, ref));
    all_.insert(all_.end(), kind.bodies.begin(), kind.bodies.begin() + kind.bodyCount);
  }
  std::sort(all_.begin(), all_.end());
  all_.erase(std::unique(all_.begin(), all_.end()), all_.end());
  for (const BodyId body : all_) {
    if (masses[body].m > 0) bodies_.push_back(body);
  }
  topology_ = topologyOf(refs, rows, all_, masses, known);
  for (const int i : topology_->order) {
    refs_.push_back(refs[i]);
    kinds_.push_back(rows[i]);
  }
  pulls_.resize(refs.size());
}

// They hang together: a tree has a pair of bodies less than it has bodies.
bool Articulation::hasLoop() const {
  const auto nodeOf = [&](BodyId body) {
    return std::binary_search(bodies_.begin(), bodies_.end(), body) ? body : kWorldBody;
  };
  std::set<std::pair<BodyId, BodyId>> pairs;
  for (const JointKind& kind : kinds_) {
    if (kind.bodyCount < 2) continue;
    const BodyId a = nodeOf(kind.bodies[0]), b = nodeOf(kind.bodies[1]);
    if (a != b) pairs.insert(std::minmax(a, b));
  }
  const bool isHeld = bodies_.size() < all_.size();
  return pairs.size() >= bodies_.size() + (isHeld ? 1 : 0);
}

void Articulation::forget() { std::fill(pulls_.begin(), pulls_.end(), Pull{}); }

void Articulation::archive(Archive& a) {
  for (auto& [lambda, arm, linear] : pulls_) a(lambda, arm, linear);
  a(holdsBothWays_, givesWay_, isOpened_);
}

// A bit for each limit that carried in the last step, by 64.
std::uint64_t Articulation::carryingLimits() const {
  std::uint64_t bits = 0;
  for (std::size_t i = topology_->tailStart; i < pulls_.size(); ++i) {
    if (pulls_[i].lambda[0] != 0) bits |= std::uint64_t{1} << (i - topology_->tailStart) % 64;
  }
  return bits;
}

// A limit that is free in one lane is solved for in all of them: to each one are taken those that
// add the fewest, of the next `most` to the second.
void JointPacks::groupAlike(std::vector<Articulation*>& list, std::size_t most) {
  if (list.size() <= most) return;
  limits_.clear();
  for (const Articulation* of : list) limits_.push_back(of->carryingLimits());
  std::uint64_t together = 0;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (k % most == 0) {
      together = limits_[k];
      continue;
    }
    std::size_t best = k;
    int fewest = 64;
    for (std::size_t i = k; i < std::min(k + most * most, list.size()) && fewest > 0; ++i) {
      const int adds = std::popcount(limits_[i] & ~together);
      if (adds < fewest) best = i, fewest = adds;
    }
    together |= limits_[best];
    std::rotate(list.begin() + k, list.begin() + best, list.begin() + best + 1);
    std::rotate(limits_.begin() + k, limits_.begin() + best, limits_.begin() + best + 1);
  }
}

template <class F>
void JointPacks::forEach(F&& f) {
  const auto ofWidth = [&](auto& packs) {
    for (std::size_t k = 0; k < packs.count; ++k) f(packs.of[k]);
  };
  std::apply([&](auto&... packs) { (ofWidth(packs), ...); }, packs_);
}

void JointPacks::take(std::span<Articulation> articulations, std::span<const int> which) {
  for (auto& list : byTopology_) list.clear();
  for (const int k : which) {
    const std::size_t topology = articulations[k].topology_->index;
    if (topology >= byTopology_.size()) byTopology_.resize(topology + 1);
    byTopology_[topology].push_back(&articulations[k]);
  }
  const auto add = [](auto& packs, std::span<Articulation* const> of) {
    if (packs.count == packs.of.size()) packs.of.emplace_back();
    packs.of[packs.count++].take(of);
  };
  std::apply([](auto&... packs) { ((packs.count = 0), ...); }, packs_);
  const std::size_t most = mostJointLanes();
  for (auto& list : byTopology_) {
    groupAlike(list, most);
    for (std::size_t k = 0; k < list.size(); k += most) {
      const std::span of = std::span(list).subspan(k, std::min(most, list.size() - k));
      if (of.size() == 1) {
        add(std::get<Packs<1>>(packs_), of);
      } else if (of.size() <= 4) {
        add(std::get<Packs<4>>(packs_), of);
      } else {
        add(std::get<Packs<8>>(packs_), of);
      }
    }
  }
}

void JointPacks::stiffen(std::span<Mat3> stiffness) {
  forEach([&](auto& pack) { pack.stiffen(stiffness); });
}

void JointPacks::leave(const JointStage& stage, double most, double ofLimits) {
  forEach([&](auto& pack) { pack.leave(stage, most, ofLimits); });
}

void JointPacks::seeStart(const JointStage& stage) {
  forEach([&](auto& pack) { pack.seeStart(stage); });
}

bool JointPacks::areNearlyClosed(const JointStage& stage) {
  bool are = true;
  forEach([&](auto& pack) { are = pack.areNearlyClosed(stage) && are; });
  return are;
}

bool JointPacks::findApart(std::span<double> marks) {
  bool any = false;
  forEach([&](auto& pack) { any = pack.findApart(marks) || any; });
  return any;
}

void JointPacks::forgetClosing(const JointStage& stage, std::span<const Displacement> predicted) {
  forEach([&](auto& pack) { pack.forgetClosing(stage, predicted); });
}

void JointPacks::seePositions(const JointStage& stage) {
  forEach([&](auto& pack) { pack.seePositions(stage); });
}

void JointPacks::followPositions(const JointStage& stage) {
  forEach([&](auto& pack) { pack.followPositions(stage); });
}

void JointPacks::startTurns(const JointStage& stage, const LaneBodies& lanes) {
  forEach([&](auto& pack) { pack.startTurns(stage, lanes); });
}

void JointPacks::followPositions(const LaneBodies& lanes, std::span<const double> wanted) {
  forEach([&](auto& pack) { pack.followPositions(lanes, wanted); });
}

void JointPacks::tell(const JointStage& stage) {
  forEach([&](auto& pack) { pack.tell(stage); });
}

void JointPacks::closePositions(const JointStage& stage, std::span<const Displacement> predicted) {
  forEach([&](auto& pack) { pack.closePositions(stage, predicted); });
}

void JointPacks::startVelocities(const JointStage& stage) {
  forEach([&](auto& pack) {
    pack.prepareVelocities(stage);
    pack.solveVelocities(stage);
  });
}

void JointPacks::solveVelocities(const JointStage& stage) {
  forEach([&](auto& pack) { pack.solveVelocities(stage); });
}

void JointPacks::solveVelocities(const LaneBodies& lanes, std::span<const double> wanted) {
  forEach([&](auto& pack) { pack.solveVelocities(lanes, wanted); });
}

void JointPacks::refineVelocities(const JointStage& stage) {
  forEach([&](auto& pack) { pack.refineVelocities(stage); });
}

void JointPacks::respond() {
  forEach([&](auto& pack) { pack.respond(); });
}

void JointPacks::addRows(std::vector<SharedRow>& rows) {
  forEach([&](auto& pack) { pack.addRows(rows); });
}

void JointPacks::finish(Kinds& kinds, double h) {
  forEach([&](auto& pack) { pack.finish(kinds, h); });
}

}  // namespace physics
