// Non-linear Gauss-Seidel.
#include "physics/methods/nonlinear_gauss_seidel.h"

#include "physics/constraint_solve.h"

namespace physics {
namespace {

void nameCulprit(StepReport& report, const char* kind, std::size_t index, BodyId body) {
  report.notFinite = {report.substeps, body, std::string(kind) + " " + std::to_string(index)};
}

bool isDirect(const World::Impl& world) { return world.settings.method == Method::kDirect; }

template <class C>
bool solveOne(Set<C>& set, std::size_t k, Bodies& bodies, double dt) {
  if constexpr (C::kBodies == kMany) {
    return solve(set.items[k], set.lambda[k], set.tuned[k], bodies, dt, set.scratch);
  } else {
    Scratch<C> scratch;
    return solve(set.items[k], set.lambda[k], set.tuned[k], bodies, dt, scratch);
  }
}

template <class K>
bool sweepKind(K& kind, Bodies& bodies, double dt, bool joints, StepReport& report) {
  auto& set = kind.set;
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    if (!joints && isEquality(set.items[k])) continue;
    ++report.constraintEvaluations;
    if (solveOne(set, k, bodies, dt)) continue;
    nameCulprit(report, K::kWord, k, set.items[k].bodies[0]);
    return false;
  }
  return true;
}

bool sweepContacts(World::Impl& world, double dt, bool backward, StepReport& report) {
  report.residual = 0;
  if (!world.settings.contact) return true;
  const double allowance = world.settings.contact->maxSeparationSpeed * dt;
  auto& pairs = world.contacts.pairs;
  report.constraintEvaluations += static_cast<std::int64_t>(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t k = backward ? pairs.size() - 1 - i : i;
    const double error =
        solve(pairs[k], world.bodies, world.settings.relaxation, allowance, backward);
    if (!std::isfinite(error)) {
      nameCulprit(report, "contact", k, pairs[k].a);
      return false;
    }
    report.residual = std::max(report.residual, error);
  }
  return true;
}

bool sweepSoftContacts(World::Impl& world, double dt, StepReport& report) {
  if (world.softContacts.empty()) return true;
  const double allowance = world.settings.contact->maxSeparationSpeed * dt;
  report.constraintEvaluations += static_cast<std::int64_t>(world.softContacts.size());
  for (std::size_t k = 0; k < world.softContacts.size(); ++k) {
    SoftContact& contact = world.softContacts[k];
    if (solve(contact, world.bodies, world.settings.relaxation, allowance)) continue;
    nameCulprit(report, "soft contact", k, contact.body);
    return false;
  }
  return true;
}

// How long to go on. The first substep has no multipliers to start from: it may settle for long,
// once.
struct Patience {
  int least, most;
  double tolerance;
};

Patience patience(const World::Impl& world, const StepReport& report) {
  const Settings& s = world.settings;
  if (world.stepCount == 0 && report.substeps == 0) {
    return {s.iterations, std::max(s.iterations, 1500), 1e-4 * s.tolerance};
  }
  return {s.iterations, s.maxIterations, s.tolerance};
}

// Conjugate directions are those of the contacts alone: with joints between them they would not be
// conjugate.
bool onlyContacts(const World::Impl& world) {
  bool only = true;
  forEachKind(world.kinds, [&](const auto& kind) { only = only && kind.set.items.empty(); });
  return only;
}

}  // namespace

void refreshInverseMasses(World::Impl& world, double dt) {
  world.settings.spinInertia ? refreshSpinInertia(world.bodies, dt) : refreshInertia(world.bodies);
}

void prepareConstraints(World::Impl& world, double dt) {
  const bool isLinear = world.settings.method == Method::kLinearGaussSeidel;
  const bool warm = world.settings.warmStartJoints && !isLinear;
  forEachKind(world.kinds, [&](auto& kind) {
    auto& set = kind.set;
    for (std::size_t k = 0; k < set.items.size(); ++k) {
      if (isDirect(world) && isEquality(set.items[k]))
        continue;  // goes on from its last multipliers
      prepare(set.items[k], set.lambda[k], warm, set.tuned[k].split, world.bodies, dt);
    }
  });
  for (ContactPair& pair : world.contacts.pairs) {
    prepare(pair, world.bodies, world.settings.warmStart && !isLinear);
  }
}

bool sweep(World::Impl& world, double dt, bool backward, StepReport& report) {
  const bool joints = !isDirect(world);
  bool finite = true;
  forEachKind(world.kinds, [&](auto& kind) {
    finite = finite && sweepKind(kind, world.bodies, dt, joints, report);
  });
  finite = finite && sweepSoftContacts(world, dt, report);
  return finite && sweepContacts(world, dt, backward, report);
}

void iterate(World::Impl& world, double dt, StepReport& report,
             const std::function<bool()>& beforeSweep) {
  const Patience limit = patience(world, report);
  const bool accelerated = onlyContacts(world);
  for (int k = 0; k < limit.least || (k < limit.most && report.residual > limit.tolerance); ++k) {
    const int extra = k - limit.least;  // beyond the least: forwards and backwards in turn
    if (accelerated && extra == 0) world.conjugate.begin(world.contacts);
    if (accelerated && extra > 0 && extra % 2 == 0) {
      world.conjugate.accelerate(world.contacts, world.bodies);
    }
    if (k > 0 && world.settings.refreshInertia) refreshInverseMasses(world, dt);
    if (beforeSweep && !beforeSweep()) return;
    if (!sweep(world, dt, extra > 0 && extra % 2 == 1, report)) return;
    ++report.iterations;
  }
  const bool settling = limit.tolerance < world.settings.tolerance;
  for (ContactPair& pair : world.contacts.pairs) {
    for (ContactPointState& point : pair.points) point.settled = settling;
  }
}

void nonlinearGaussSeidel(World::Impl& world, double dt, StepReport& report) {
  iterate(world, dt, report, {});
}

}  // namespace physics
