// What a solve tells about the motion: who is held, whose velocities jump, and who is too stiff for
// the symmetric scheme.
#include <algorithm>
#include <cmath>

#include "physics/constraints/constraint_response.h"
#include "physics/effects/choose_scheme.h"

namespace physics {
namespace {

// The symmetric scheme is stable up to w h = 2, w the fastest of the motion. The bodies' own
// stiffness over their mass, K/m, is half of the chain's largest w^2 (NOTES 6: 4T/(m l) against
// 2T/(m l)): this bound on h^2 K/m leaves a half.
constexpr double kSymmetricBound = 1;

template <class C>
bool isTwoSided(const Evaluated<C>& row) {
  if constexpr (Force<C>) {
    return true;
  } else {
    if (!canStand<C>()) return false;
    constexpr double kFree = std::numeric_limits<double>::infinity();
    return row.low == -kFree && row.high == kFree && row.longest == kFree && row.alpha == 0;
  }
}

// J^T K J of a force, and the stiffness by which a load on a lever or along a link resists turning;
// per body, h^2 K/m at most.
template <class C>
void addStiffness(const C& item, const Multipliers<C>& lambda, const Evaluated<C>& row,
                  const WorldState& w, std::vector<double>& ratio) {
  const double h = w.bodies.second.h;
  const double scale = lambda.step > 0 ? h / lambda.step : 0;
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const BodyId body = item.bodies[b];
    const InverseMass& inverse = w.bodies.inverse[body];
    if (inverse.m == 0) continue;
    if constexpr (Force<C>) {
      double k = 0;
      if constexpr (C::kLinear) {
        k += inverse.m * (row.linear[b].transpose() * row.k * row.linear[b]).trace() / 3;
      }
      if constexpr (isAngular<C>()) {
        k += (inverse.inertia * row.angular[b].transpose() * row.k * row.angular[b]).trace() / 3;
      }
      ratio[body] += 4 * k;
    } else if constexpr (C::kLinear) {
      const Vec3 force = row.linear[b].transpose() * lambda.total * (scale * scale);
      if constexpr (requires { item.anchors; } && isAngular<C>()) {
        const Vec3 arm = w.bodies.pose[body].q * item.anchors[b];
        ratio[body] += std::max(force.dot(arm), 0.0) * inverse.inertia.trace() / 3;
      }
      if constexpr (requires { item.length; } && C::kBodies == 2) {
        if (item.length > 0) ratio[body] += inverse.m * force.norm() / item.length;
      }
    }
  }
}

// How stiff the motion is matters only where some body steps symmetrically, or is to.
bool asksForStiffness(const WorldState& w) {
  const std::vector<Scheme>& scheme = w.bodies.second.scheme;
  return w.settings.stepping == Stepping::kSymmetric ||
         std::any_of(scheme.begin(), scheme.end(),
                     [](Scheme s) { return s == Scheme::kSymmetric; });
}

// What the solve found: who is held by limits, whose velocities jump at one, and who is too stiff.
void inspectKinds(WorldState& w) {
  Stepper& stepper = w.stepper;
  std::vector<double>& ratio = stepper.ratio;
  const bool asks = asksForStiffness(w);
  forEachKind(w.kinds, [&](auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    for (const int k : kind.set.active) {
      const C& item = kind.set.items[k];
      if (!asks && (Force<C> || isEquality(item))) continue;
      const Multipliers<C>& lambda = kind.set.lambda[k];
      Scratch<C> local;
      Scratch<C>& s = C::kBodies == kMany ? kind.set.scratch : local;
      item.evaluate(configurationOf(item, w.bodies, w.substepLength()), s.row);
      const bool isHeld = !isTwoSided<C>(s.row) && !lambda.total.isZero(0);
      for (const BodyId body : item.bodies) {
        if (isHeld) stepper.bounded[body] = true;
        if (isHeld && !lambda.loaded) stepper.smooth[body] = false;
      }
      if (asks && s.row.active) addStiffness(item, lambda, s.row, w, ratio);
    }
  });
}

const ContactPair* findPair(const std::vector<ContactPair>& pairs, std::uint64_t key) {
  const auto before = [](const ContactPair& pair, std::uint64_t wanted) {
    return pair.key < wanted;
  };
  const auto found = std::lower_bound(pairs.begin(), pairs.end(), key, before);
  return found != pairs.end() && found->key == key ? &*found : nullptr;
}

double speedGiven(const WorldState& w, const ContactPair* pair) {
  return pair == nullptr ? 0 : speedGiven(w, *pair);
}

// Contacts whose impulse is more than twice, or less than half, that of the last substep: impacts,
// on what touched before as well, and what lets go. Smaller ones than gravity's do not count.
void compareContacts(WorldState& w, double least) {
  Stepper& stepper = w.stepper;
  for (const ContactPair& pair : w.contacts.pairs) {
    const double now = speedGiven(w, pair);
    if (!(now > least) || now <= 2 * speedGiven(w, findPair(w.contactsBefore, pair.key))) continue;
    stepper.smooth[pair.a] = stepper.smooth[pair.b] = false;
  }
  for (const ContactPair& pair : w.contactsBefore) {
    const double before = speedGiven(w, pair);
    if (!(before > least) || 2 * speedGiven(w, findPair(w.contacts.pairs, pair.key)) >= before) {
      continue;
    }
    stepper.parted[pair.a] = stepper.parted[pair.b] = true;
  }
}

void inspectContacts(WorldState& w, double h) {
  Stepper& stepper = w.stepper;
  const double speed = jumpSpeed(w, h);
  compareContacts(w, speed);
  for (const ContactPair& pair : w.contacts.pairs) {
    if (!isLoaded(pair)) continue;
    stepper.bounded[pair.a] = stepper.bounded[pair.b] = true;
    if (jumps(pair, speed)) stepper.smooth[pair.a] = stepper.smooth[pair.b] = false;
  }
  for (const SoftContact& c : w.softContacts) {
    if (c.normalTotal == 0) continue;
    for (const BodyId body : {c.from, c.to, c.body}) stepper.smooth[body] = false;
  }
}

}  // namespace

// Speeds that gravity gives within two steps are no jump.
double jumpSpeed(const WorldState& w, double h) {
  return w.settings.gravity ? 2 * h * w.settings.gravity->norm() : 0;
}

bool jumps(const ContactPair& pair, double speed) {
  for (int k = 0; k < pair.count; ++k) {
    const ContactPointState& p = pair.points[k];
    if (p.normalTotal > 0 && !p.loaded && p.approach < -speed) return true;
  }
  return false;
}

double speedGiven(const WorldState& w, const ContactPair& pair) {
  const double inverseMass = w.bodies.inverse[pair.a].m + w.bodies.inverse[pair.b].m;
  return pair.step > 0 ? inverseMass * impulseOf(pair).norm() / pair.step : 0;
}

void inspectMotion(WorldState& w, double h) {
  Stepper& stepper = w.stepper;
  stepper.ratio.resize(w.bodies.pose.size());
  for (const BodyId i : w.bodies.active) {
    stepper.smooth[i] = true;
    stepper.bounded[i] = stepper.parted[i] = false;
    stepper.ratio[i] = 0;
  }
  inspectKinds(w);
  inspectContacts(w, h);
  for (const BodyId i : w.bodies.active)
    stepper.unresolved[i] = !(stepper.ratio[i] <= kSymmetricBound);
}

}  // namespace physics
