// The choice of a scheme.
#include "physics/effects/choose_scheme.h"

#include <algorithm>
#include <cmath>

#include "physics/constraints/constraint_response.h"
#include "physics/model/islands.h"
#include "physics/motion/second_order.h"

namespace physics {
namespace {

// Joined bodies, and those that a contact moves in this substep.
void findIslands(WorldState& w) {
  Islands& island = w.stepper.island;
  const Islands& joined = jointIslands(w);
  for (const BodyId i : w.bodies.active) island[i] = joined[i];
  joinPushed(w.contacts, w.bodies, island);
  for (const SoftContact& c : w.softContacts) {
    if (c.normalTotal == 0) continue;
    join(w.bodies, island, c.from, c.to);
    join(w.bodies, island, c.from, c.body);
  }
  settle(island, w.bodies.active);
}

Scheme best(const WorldState& w, const Allowed& allowed) {
  const bool prefersBdf2 = w.settings.stepping == Stepping::kBdf2;
  if (allowed.bdf2 && (prefersBdf2 || !allowed.symmetric)) return Scheme::kBdf2;
  return allowed.symmetric ? Scheme::kSymmetric : Scheme::kPaper;
}

// Every island steps by the best scheme that all its bodies allow.
void settleSchemes(WorldState& w) {
  Stepper& stepper = w.stepper;
  std::vector<Scheme>& scheme = w.bodies.second.scheme;
  for (const BodyId i : w.bodies.active) {
    Allowed& shared = stepper.allowed[stepper.island[i]];
    shared.bdf2 = shared.bdf2 && stepper.allowed[i].bdf2;
    shared.symmetric = shared.symmetric && stepper.allowed[i].symmetric;
  }
  for (const BodyId i : w.bodies.active) {
    stepper.allowed[i] = stepper.allowed[stepper.island[i]];
    scheme[i] = best(w, stepper.allowed[i]);
  }
}

bool hasPast(const WorldState& w, BodyId body) {
  return w.bodies.motion[body] == Motion::kKinematic || w.bodies.second.history[body].smooth;
}

// A turn in one substep that bdf2 does not resolve: beyond some .6 rad a free body that is not
// isotropic gains angular momentum without bounds.
bool turnsFar(const WorldState& w, BodyId body) {
  constexpr double kFar = 0.5;  // rad
  const double turn = w.bodies.velocity[body].w.norm() * w.substepLength();
  return turn > kFar && !isIsotropic(w.bodies.inertia[body]);
}

// What one body of an island met, all of it met.
void shareWithinIslands(const WorldState& w, std::vector<bool>& flag, bool shared) {
  const std::vector<BodyId>& island = w.stepper.island;
  for (const BodyId i : w.bodies.active) {
    if (flag[i] == shared) flag[island[i]] = shared;
  }
  for (const BodyId i : w.bodies.active) flag[i] = flag[island[i]];
}

void inspect(WorldState& w, double h) {
  inspectMotion(w, h);
  Stepper& stepper = w.stepper;
  findIslands(w);
  shareWithinIslands(w, stepper.parted, true);
  shareWithinIslands(w, stepper.smooth, false);
  shareWithinIslands(w, stepper.unresolved, true);
  shareWithinIslands(w, stepper.bounded, true);
}

// Bodies that a bounce has parted are free again.
void freeBounced(WorldState& w) {
  if (!w.settings.contact || w.bodies.mostRestitution == 0) return;
  Stepper& stepper = w.stepper;
  const double speed = jumpSpeed(w, w.substepLength());
  for (const ContactPair& pair : w.contacts.pairs) {
    if (!jumps(pair, speed)) continue;
    stepper.bounded[stepper.island[pair.a]] = stepper.bounded[stepper.island[pair.b]] = false;
  }
  shareWithinIslands(w, stepper.bounded, false);
}

}  // namespace

bool isSecondOrder(const Settings& settings) {
  return settings.stepping == Stepping::kBdf2 || settings.stepping == Stepping::kSymmetric;
}

void chooseSchemes(WorldState& w) {
  Stepper& stepper = w.stepper;
  const auto size = static_cast<std::size_t>(w.bodies.size());
  if (w.bodies.second.scheme.size() != size) {
    makeRoom(w.bodies.second, w.bodies.pose);
    stepper.island = jointIslands(w);
    stepper.allowed.resize(size);
    stepper.unresolved.assign(size, false);
    stepper.bounded.assign(size, false);
    stepper.smooth.assign(size, true);
    stepper.parted.assign(size, false);
  }
  for (const BodyId i : w.bodies.active) {
    stepper.allowed[i] = {hasPast(w, i) && !turnsFar(w, i),
                          !stepper.unresolved[i] && !stepper.bounded[i]};
  }
  findIslands(w);
  settleSchemes(w);
}

bool lowerSchemes(WorldState& w, double h) {
  inspect(w, h);
  Stepper& stepper = w.stepper;
  const std::vector<Scheme>& scheme = w.bodies.second.scheme;
  stepper.tried = scheme;
  for (const BodyId i : w.bodies.active) {
    Allowed& allowed = stepper.allowed[i];
    allowed.bdf2 = allowed.bdf2 && stepper.smooth[i] && !stepper.parted[i];
    allowed.symmetric =
        allowed.symmetric && stepper.smooth[i] && !stepper.unresolved[i] && !stepper.bounded[i];
  }
  settleSchemes(w);
  return scheme != stepper.tried;
}

void stepByPaper(WorldState& w) {
  for (const BodyId i : w.bodies.active) w.stepper.allowed[i] = {};
  settleSchemes(w);
}

void recordSchemes(WorldState& w, const std::vector<bool>& jumped, StepReport& report) {
  freeBounced(w);
  for (std::size_t i = 0; i < jumped.size(); ++i) {
    if (jumped[i]) w.stepper.smooth[i] = false;
  }
  const bool wantsBdf2 = w.settings.stepping == Stepping::kBdf2;
  for (const BodyId i : w.bodies.active) {
    if (w.bodies.motion[i] != Motion::kDynamic) continue;
    const Scheme scheme = w.bodies.second.scheme[i];
    report.restarts += scheme == Scheme::kPaper || (wantsBdf2 && scheme == Scheme::kSymmetric);
    report.fallbacks += !wantsBdf2 && scheme == Scheme::kBdf2;
  }
  remember(w.bodies, w.stepper.smooth);
}

}  // namespace physics
