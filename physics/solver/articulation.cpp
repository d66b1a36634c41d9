// Articulations, and which of them step side by side.
#include "physics/solver/articulation.h"

#include <algorithm>
#include <set>

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

template <class F>
void JointPacks::forEach(F&& f) {
  for (std::size_t k = 0; k < oneCount_; ++k) f(ones_[k]);
  for (std::size_t k = 0; k < fourCount_; ++k) f(fours_[k]);
}

void JointPacks::take(std::span<Articulation> articulations, std::span<const int> which) {
  for (auto& list : byTopology_) list.clear();
  for (const int k : which) {
    const std::size_t topology = articulations[k].topology_->index;
    if (topology >= byTopology_.size()) byTopology_.resize(topology + 1);
    byTopology_[topology].push_back(&articulations[k]);
  }
  const auto add = [&](auto& packs, std::size_t& count, std::span<Articulation* const> of) {
    if (count == packs.size()) packs.emplace_back();
    packs[count++].take(of);
  };
  oneCount_ = fourCount_ = 0;
  for (const auto& list : byTopology_) {
    for (std::size_t k = 0; k < list.size(); k += 4) {
      const std::span of = std::span(list).subspan(k, std::min<std::size_t>(4, list.size() - k));
      if (of.size() == 1) {
        add(ones_, oneCount_, of);
      } else {
        add(fours_, fourCount_, of);
      }
    }
  }
  takeTurnPacks();
}

// Of each topology fours go in pairs.
void JointPacks::takeTurnPacks() {
  turnCount_ = 0;
  const auto add = [&](std::size_t first, int ones, int fours) {
    if (turnCount_ == turns_.size()) turns_.emplace_back();
    Turn& turn = turns_[turnCount_++];
    turn.first = first;
    turn.ones = ones;
    turn.fours = fours;
  };
  for (std::size_t k = 0; k < oneCount_; ++k) {
    if (ones_[k].hasTurns()) add(k, 1, 0);
  }
  for (std::size_t k = 0; k < fourCount_; ++k) {
    if (!fours_[k].hasTurns()) continue;
    const bool isPair = k + 1 < fourCount_ && fours_[k].isLike(fours_[k + 1]);
    add(k, 0, isPair ? 2 : 1);
    if (isPair) ++k;
  }
}

// f(packs, what they take turns with)
template <class F>
void JointPacks::forEachTurn(F&& f) {
  for (std::size_t k = 0; k < turnCount_; ++k) {
    Turn& turn = turns_[k];
    if (turn.ones > 0) {
      JointPack<1>* const one[1] = {&ones_[turn.first]};
      f(std::span<JointPack<1>* const>(one), turn.pack);
    } else {
      JointPack<4>* const fours[2] = {&fours_[turn.first], &fours_[turn.first + turn.fours - 1]};
      f(std::span<JointPack<4>* const>(fours, turn.fours), turn.pack);
    }
  }
}

void JointPacks::follow(const LaneBodies& lanes) {
  for (std::size_t k = 0; k < turnCount_; ++k) turns_[k].pack.follow(lanes.motions);
}

void JointPacks::stiffen(std::span<Mat3> stiffness) const {
  for (std::size_t k = 0; k < oneCount_; ++k) ones_[k].stiffen(stiffness);
  for (std::size_t k = 0; k < fourCount_; ++k) fours_[k].stiffen(stiffness);
}

void JointPacks::leave(const JointStage& stage, double most) {
  forEach([&](auto& pack) { pack.leave(stage, most); });
}

void JointPacks::seePositions(const JointStage& stage) {
  forEach([&](auto& pack) { pack.seePositions(stage); });
}

void JointPacks::followPositions(const JointStage& stage) {
  forEach([&](auto& pack) { pack.followPositions(stage); });
}

void JointPacks::startTurns(const JointStage& stage, const LaneBodies& lanes) {
  forEach([&](auto& pack) {
    if (!pack.hasTurns()) pack.startTurns(stage, lanes);
  });
  forEachTurn([&](auto packs, TurnPack& turn) {
    for (auto* pack : packs) pack->seeTurns(stage);
    turn.take(packs, lanes, TurnStage::kPositions);
  });
  follow(lanes);
}

void JointPacks::followPositions(const LaneBodies& lanes) {
  forEach([&](auto& pack) {
    if (!pack.hasTurns()) pack.followPositions(lanes);
  });
  follow(lanes);
}

void JointPacks::tell(const JointStage& stage) {
  forEach([&](auto& pack) {
    if (!pack.hasTurns()) pack.tell(stage);
  });
  forEachTurn([&](auto packs, TurnPack& turn) { turn.giveBack(packs); });
}

void JointPacks::closePositions(const JointStage& stage, double tolerance) {
  forEach([&](auto& pack) { pack.closePositions(stage, tolerance); });
}

void JointPacks::prepareVelocities(const JointStage& stage) {
  forEach([&](auto& pack) { pack.prepareVelocities(stage); });
}

void JointPacks::solveVelocities(const JointStage& stage) {
  forEach([&](auto& pack) { pack.solveVelocities(stage); });
}

void JointPacks::solveVelocities(const JointStage& stage, std::span<const double> wanted) {
  forEach([&](auto& pack) { pack.solveVelocities(stage, wanted); });
}

void JointPacks::startVelocityTurns(const JointStage& stage, const LaneBodies& lanes) {
  forEach([&](auto& pack) {
    if (pack.hasTurns()) return;
    pack.prepareVelocities(stage);
    pack.solveVelocities(stage);
  });
  forEachTurn([&](auto packs, TurnPack& turn) {
    for (auto* pack : packs) {
      pack->prepareVelocities(stage);
      pack->solveVelocities(stage);
    }
    turn.take(packs, lanes, TurnStage::kVelocities);
  });
}

void JointPacks::solveVelocities(const LaneBodies& lanes) {
  forEach([&](auto& pack) {
    if (!pack.hasTurns()) pack.solveVelocities(lanes);
  });
  follow(lanes);
}

void JointPacks::refineVelocities(const JointStage& stage) {
  forEach([&](auto& pack) { pack.refineVelocities(stage); });
}

void JointPacks::respond() {
  forEach([&](auto& pack) { pack.respond(); });
}

void JointPacks::finish(Kinds& kinds, double h) {
  forEach([&](auto& pack) { pack.finish(kinds, h); });
}

}  // namespace physics
