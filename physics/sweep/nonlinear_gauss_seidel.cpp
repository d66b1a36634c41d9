// Non-linear Gauss-Seidel.
#include "physics/sweep/nonlinear_gauss_seidel.h"

#include <algorithm>

#include "physics/base/profile.h"
#include "physics/constraints/constraint_start.h"
#include "physics/constraints/constraint_symmetric.h"
#include "physics/motion/second_order.h"
#include "physics/sweep/direct.h"

namespace physics {
namespace {

bool isDirect(const SweepModel& world) { return world.settings.method == Method::kDirect; }

template <class C>
bool solveOne(Set<C>& set, std::size_t k, Bodies& bodies, const Configuration& at,
              Scratch<C>& scratch) {
  if (bodies.second.empty()) {
    return solve(set.items[k], set.lambda[k], set.tuned[k], bodies, at, scratch);
  }
  if (isSymmetric(set.items[k], bodies)) {
    return solveSymmetric(set.items[k], set.lambda[k], set.tuned[k], bodies, scratch);
  }
  return solve(set.items[k], set.lambda[k], set.tuned[k], bodies, at.dt, scratch);
}

// `at`: where all bodies step by the paper's scheme.
template <class C>
bool solveOne(Set<C>& set, std::size_t k, Bodies& bodies, const Configuration& at) {
  if constexpr (C::kBodies == kMany) return solveOne(set, k, bodies, at, set.scratch);
  Scratch<C> scratch;
  return solveOne(set, k, bodies, at, scratch);
}

template <class K>
bool sweepKind(K& kind, Bodies& bodies, double dt, bool joints, StepReport& report) {
  auto& set = kind.set;
  if (set.active.empty()) return true;
  profileScope(K::kWord);
  const Configuration at{bodies.pose, bodies.start, dt};
  for (const int k : set.active) {
    if (!joints && isSolvedDirectly(set.items[k])) continue;
    ++report.constraintEvaluations;
    if (solveOne(set, k, bodies, at)) continue;
    nameCulprit(report, K::kWord, k, moverOf(set.items[k], bodies));
    return false;
  }
  return true;
}

bool sweepContacts(SweepModel& world, double dt, bool backward, StepReport& report) {
  report.residual = 0;
  if (!world.settings.contact) return true;
  profileScope("contact");
  const double allowance = world.settings.contact->maxSeparationSpeed * dt;
  auto& pairs = world.contacts.pairs;
  report.constraintEvaluations += static_cast<std::int64_t>(pairs.size());
  report.work.contactVisits += static_cast<std::int64_t>(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t k = backward ? pairs.size() - 1 - i : i;
    report.work.frictionRows += pairs[k].frictional ? 2 * pairs[k].count : 0;
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

bool sweepSoftContacts(SweepModel& world, double dt, StepReport& report) {
  if (world.softContacts.empty()) return true;
  profileScope("soft_contact");
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

// Second-order steppings: Newton goes on until no joint is further open, in the unit of its rows.
constexpr double kClosed = 1e-9;

// Rates of equalities that the projection leaves [m/s, rad/s].
constexpr double kProjected = 1e-10;

template <class C>
double projectKind(Set<C>& set, SweepModel& world) {
  double change = 0;
  if constexpr (!Force<C> && canStand<C>()) {
    for (const int k : set.active) {
      if (isDirect(world) && isSolvedDirectly(set.items[k])) continue;
      if (!isSymmetric(set.items[k], world.bodies)) continue;
      Scratch<C> local;
      Scratch<C>& scratch = C::kBodies == kMany ? set.scratch : local;
      change = std::max(change, projectVelocity(set.items[k], world.bodies, scratch));
    }
  }
  return change;
}

// How long to go on. The first substep has no multipliers to start from: it may settle for long,
// once.
struct Patience {
  int least, most;
  double tolerance;
};

Patience patience(const SweepModel& world) {
  const Settings& s = world.settings;
  if (world.stepCount == 0 && world.substep == 0) {
    return {s.iterations, std::max(s.iterations, 1500), 1e-4 * s.tolerance};
  }
  return {s.iterations, s.maxIterations, s.tolerance};
}

// Contacts start from their last multipliers. Joints do not: of a jointed body those may carry more
// than its own weight, which alone would throw it.
void prepareContacts(SweepModel& world, bool warm) {
  if (world.contacts.pairs.empty()) return;
  profileScope("contact");
  const std::vector<bool>& attached = world.findAttached();
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  for (ContactPair& pair : world.contacts.pairs) {
    const bool jointed = attached[pair.a] || attached[pair.b];
    const double farthest = jointed ? world.settings.contact->margin : kAnywhere;
    prepare(pair, world.bodies, warm ? farthest : 0);
  }
}

}  // namespace

bool onlyContacts(const SweepModel& world) {
  bool only = true;
  forEachKind(world.kinds, [&](const auto& kind) { only = only && kind.set.active.empty(); });
  return only;
}

void refreshInverseMasses(SweepModel& world, double dt) {
  world.settings.spinInertia ? refreshSpinInertia(world.bodies, dt) : refreshInertia(world.bodies);
}

void prepareConstraints(SweepModel& world, double dt) {
  const bool isLinear = world.settings.method == Method::kLinearGaussSeidel;
  const bool warm = world.settings.warmStartJoints && !isLinear;
  const std::optional<double>& speed = world.settings.maxCorrectionSpeed;
  forEachKind(world.kinds, [&](auto& kind) {
    auto& set = kind.set;
    if (set.active.empty()) return;
    profileScope(std::decay_t<decltype(kind)>::kWord);
    for (const int k : set.active) {
      if (speed) leave(set.items[k], set.lambda[k], *speed * dt, world.bodies, dt);
      if (isDirect(world) && isSolvedDirectly(set.items[k])) {  // goes on from its last multipliers
        set.lambda[k].loaded = !set.lambda[k].total.isZero(0);
        rescale(set.lambda[k], stepOf(set.items[k], world.bodies, dt));
        continue;
      }
      prepare(set.items[k], set.lambda[k], warm && !isSymmetric(set.items[k], world.bodies),
              set.tuned[k].split, world.bodies, dt);
    }
  });
  prepareContacts(world, world.settings.warmStart && !isLinear);
}

bool sweep(SweepModel& world, double dt, bool backward, StepReport& report) {
  const bool joints = !isDirect(world);
  bool finite = true;
  forEachKind(world.kinds, [&](auto& kind) {
    finite = finite && sweepKind(kind, world.bodies, dt, joints, report);
  });
  finite = finite && sweepSoftContacts(world, dt, report);
  return finite && sweepContacts(world, dt, backward, report);
}

void iterate(SweepModel& world, double dt, StepReport& report,
             const std::function<bool()>& beforeSweep) {
  const Patience limit = patience(world);
  const bool accelerated = onlyContacts(world);  // with joints between, nothing would be conjugate
  const auto isSettled = [&] {
    return report.residual <= limit.tolerance && !(world.jointError > kClosed);
  };
  for (int k = 0; k < limit.least || (k < limit.most && !isSettled()); ++k) {
    const int extra = k - limit.least;  // beyond the least: forwards and backwards in turn
    profileScope(accelerated ? "contact" : "");
    if (accelerated && extra == 0) world.conjugate.begin(world.contacts);
    if (accelerated && extra > 0 && extra % 2 == 0) {
      world.conjugate.accelerate(world.contacts, world.bodies);
    }
    if (k > 0 && !isDirect(world)) balance(world.bodies);
    if (k > 0 && world.settings.refreshInertia) {
      profileScope("inertia");
      refreshInverseMasses(world, dt);
    }
    if (beforeSweep && !beforeSweep()) return;
    if (!sweep(world, dt, extra > 0 && extra % 2 == 1, report)) return;
    ++report.iterations;
  }
  profileScope("");
  const bool settling = limit.tolerance < world.settings.tolerance;
  for (ContactPair& pair : world.contacts.pairs) {
    for (ContactPointState& point : pair.points) point.settled = settling;
  }
}

void projectVelocities(SweepModel& world) {
  const std::vector<Scheme>& scheme = world.bodies.second.scheme;
  if (std::find(scheme.begin(), scheme.end(), Scheme::kSymmetric) == scheme.end()) return;
  refreshInertia(world.bodies);
  const int most = std::max(world.settings.iterations, world.settings.maxIterations);
  double change = 1;
  for (int k = 0; k < most && change > kProjected; ++k) {
    if (isDirect(world)) projectJoints(world);
    change = 0;
    forEachKind(world.kinds,
                [&](auto& kind) { change = std::max(change, projectKind(kind.set, world)); });
  }
}

void nonlinearGaussSeidel(SweepModel& world, double dt, StepReport& report) {
  iterate(world, dt, report, {});
}

}  // namespace physics
