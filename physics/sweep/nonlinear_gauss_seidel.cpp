// Algorithm 1 of the paper: non-linear Gauss-Seidel.
#include "physics/sweep/nonlinear_gauss_seidel.h"

#include <algorithm>
#include <span>

#include "physics/base/profile.h"
#include "physics/constraints/constraint_symmetric.h"
#include "physics/motion/second_order.h"
#include "physics/sweep/direct.h"

namespace physics {
namespace {

bool isDirect(const SweepModel& world) { return world.settings.method == Method::kDirect; }

// "Prepare constraint solve data"; lambda = 0, but for Newton's steps, which go on from the last.
template <class C>
void prepareKind(Set<C>& set, SweepModel& world, double dt) {
  for (const int k : set.active) {
    Multipliers<C>& lambda = set.lambda[k];
    const double step = stepOf(set.items[k], world.bodies, dt);
    const bool goesOn = isDirect(world) && isSolvedDirectly(set.items[k]) && lambda.step > 0;
    const double ratio = goesOn ? step / lambda.step : 0;  // forces times the step squared
    lambda.loaded = !lambda.total.isZero(0);
    lambda.total *= ratio * ratio;
    lambda.step = step;
  }
}

template <class C>
bool visit(Set<C>& set, int k, Bodies& bodies, double dt) {
  Scratch<C> local;
  Scratch<C>& scratch = C::kBodies == kMany ? set.scratch : local;
  return isSymmetric(set.items[k], bodies)
             ? solveSymmetric(set.items[k], set.lambda[k], set.tuned[k], bodies, scratch)
             : solve(set.items[k], set.lambda[k], set.tuned[k], bodies, dt, scratch);
}

template <class K>
bool sweepKind(K& kind, SweepModel& world, double dt, StepReport& report) {
  auto& set = kind.set;
  if (set.active.empty()) return true;
  profileScope(K::kWord);
  for (const int k : set.active) {
    if (isDirect(world) && isSolvedDirectly(set.items[k])) continue;
    ++report.constraintEvaluations;
    if (visit(set, k, world.bodies, dt)) continue;
    nameCulprit(report, K::kWord, k, moverOf(set.items[k], world.bodies));
    return false;
  }
  return true;
}

bool sweepContacts(SweepModel& world, StepReport& report) {
  profileScope("contact");
  std::vector<ContactPair>& pairs = world.contacts.pairs;
  report.constraintEvaluations += static_cast<std::int64_t>(pairs.size());
  report.work.contactVisits += static_cast<std::int64_t>(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    report.work.frictionRows += pairs[k].frictional ? 2 * pairs[k].count : 0;
    if (solve(pairs[k], world.bodies, world.settings.relaxation)) continue;
    nameCulprit(report, "contact", k, pairs[k].a);
    return false;
  }
  return true;
}

bool sweepSoftContacts(SweepModel& world, StepReport& report) {
  profileScope("soft_contact");
  report.constraintEvaluations += static_cast<std::int64_t>(world.softContacts.size());
  for (std::size_t k = 0; k < world.softContacts.size(); ++k) {
    SoftContact& contact = world.softContacts[k];
    if (solve(contact, world.bodies, world.settings.relaxation)) continue;
    nameCulprit(report, "soft contact", k, contact.body);
    return false;
  }
  return true;
}

double furthest(std::span<const Pose> from, std::span<const Pose> to) {
  double most = 0;
  for (std::size_t i = 0; i < to.size(); ++i) most = std::max(most, (to[i].x - from[i].x).norm());
  return most;
}

}  // namespace

void refreshInverseMasses(SweepModel& world, double dt) {
  world.settings.spinInertia ? refreshSpinInertia(world.bodies, dt) : refreshInertia(world.bodies);
}

void prepareConstraints(SweepModel& world, double dt) {
  forEachKind(world.kinds, [&](auto& kind) { prepareKind(kind.set, world, dt); });
  for (ContactPair& pair : world.contacts.pairs) prepare(pair, world.bodies);
}

bool sweep(SweepModel& world, double dt, StepReport& report) {
  bool finite = true;
  forEachKind(world.kinds,
              [&](auto& kind) { finite = finite && sweepKind(kind, world, dt, report); });
  if (!world.softContacts.empty()) finite = finite && sweepSoftContacts(world, report);
  if (!world.contacts.pairs.empty()) finite = finite && sweepContacts(world, report);
  report.iterations += finite;
  profileScope("");
  return finite;
}

void refreshIterate(SweepModel& world, double dt) {
  if (!world.settings.refreshInertia) return;
  profileScope("inertia");
  refreshInverseMasses(world, dt);
}

void nonlinearGaussSeidel(SweepModel& world, double dt, StepReport& report) {
  const Settings& settings = world.settings;
  double moved = 0;
  const auto goesOn = [&](int k) {
    if (k < settings.iterations) return true;
    return settings.tolerance && k < settings.maxIterations && moved > *settings.tolerance;
  };
  for (int k = 0; goesOn(k); ++k) {
    if (k > 0) balance(world.bodies);
    if (k > 0) refreshIterate(world, dt);
    if (settings.tolerance) world.iterate = world.bodies.pose;
    if (!sweep(world, dt, report)) return;
    if (settings.tolerance) moved = furthest(world.iterate, world.bodies.pose);
  }
}

}  // namespace physics
