// How many substeps an island is to take: from the errors that its last step left.
#include <algorithm>
#include <cmath>

#include "physics/constraints/constraint_error.h"
#include "physics/constraints/constraint_response.h"
#include "physics/effects/local_substeps.h"

namespace physics {
namespace {

constexpr double kResolved = 0.5;   // w h of a spring
constexpr double kLargestTurn = 1;  // rad in a substep
constexpr double kEasy = 0.125;     // of the tolerance: with half the substeps it is below a half
constexpr int kCalm = 8;            // steps

// What an island's last step tells.
struct Need {
  double error = 0;  // m or rad
  double least = 1;  // substeps that springs and spins ask for
};

template <class C>
void look(const C& item, WorldState& w, Scratch<C>& s, Need& need) {
  const int n = w.local.substeps[moverOf(item, w.bodies)];
  if constexpr (Force<C>) {
    item.evaluate(configurationOf(item, w.bodies, w.settings.dt / n), s.row);
    if (!s.row.active) return;
    const auto a = effectiveMassInverse(item, s.row, w.bodies.inverse, s.response);
    const double square = (s.row.k * a).trace();  // >= (w h)^2, K and A are not negative
    if (square > 0) need.least = std::max(need.least, n * std::sqrt(square) / kResolved);
  } else if constexpr (canStand<C>()) {
    need.error = std::max(need.error, sizeOfError(item, w.bodies, w.substepLength()));
  }
}

std::vector<Need> needs(WorldState& w) {
  std::vector<Need> needs(w.bodies.pose.size());
  const Islands& islands = w.local.islands;
  forEachKind(w.kinds, [&](auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    Scratch<C> local;
    Scratch<C>& s = C::kBodies == kMany ? kind.set.scratch : local;
    for (const int k : kind.set.active) {
      const C& item = kind.set.items[k];
      look(item, w, s, needs[islands[moverOf(item, w.bodies)]]);
    }
  });
  for (const ContactPair& pair : w.contacts.pairs) {
    Need& need = needs[islands[isMovable(w.bodies, pair.a) ? pair.a : pair.b]];
    for (int k = 0; k < pair.count; ++k) {
      need.error = std::max(need.error, -gapOf(pair, k, w.bodies.pose));
    }
  }
  for (const BodyId i : w.bodies.active) {
    Need& need = needs[islands[i]];
    need.least = std::max(need.least, w.settings.dt * w.bodies.velocity[i].w.norm() / kLargestTurn);
  }
  return needs;
}

// The least power of two that is not below n, all of them beyond half of `most`'s.
int numberFor(double n, int most) {
  int number = 1;
  while (number < n && number < most) number *= 2;
  return std::min(number, most);
}

// The next lower one.
int fewer(int n) { return n > 1 ? numberFor(0.5 * n, n) : 1; }

}  // namespace

void askForSubsteps(WorldState& w) {
  Local& local = w.local;
  const bool isTime = !local.full || w.stepCount % kCalm == kCalm - 1;
  if (!stepsLocally(w.settings) || !isTime) return;
  if (local.full) joinAll(w);
  const int most = w.settings.substepCount();
  const std::vector<Need> all = needs(w);
  bool full = true;
  for (const BodyId i : w.bodies.active) {
    const Need& need = all[local.islands[i]];
    const int now = local.substeps[i], least = numberFor(need.least, most);
    const double share = need.error / w.settings.localTolerance;
    const int calm = local.full ? kCalm : local.calm[i] + 1;
    local.calm[i] = share < kEasy && least < now ? calm : 0;
    int next = now;
    if (!(share <= 1)) next = numberFor(std::max(now * std::sqrt(share), now + 1.0), most);
    if (local.calm[i] >= kCalm) next = fewer(now), local.calm[i] = 0;
    local.wanted[i] = std::max(next, least);
    full = full && local.wanted[i] == most && now == most;
  }
  local.full = full;
  local.last = local.substeps;
  local.joins.clear();
}

}  // namespace physics
