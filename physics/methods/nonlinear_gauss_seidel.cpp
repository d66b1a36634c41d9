// Non-linear Gauss-Seidel.
#include "physics/methods/nonlinear_gauss_seidel.h"

namespace physics {
namespace {

void nameCulprit(StepReport& report, const char* kind, std::size_t index, BodyId body) {
  report.notFinite = {report.substeps, body, std::string(kind) + " " + std::to_string(index)};
}

bool isDirect(const World::Impl& world) { return world.settings.method == Method::kDirect; }

template <class K>
bool sweepKind(K& kind, Bodies& bodies, double dt, bool joints, StepReport& report) {
  auto& set = kind.set;
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    if (!joints && isEquality(set.items[k])) continue;
    ++report.constraintEvaluations;
    if (solve(set.items[k], set.lambda[k], set.tuned[k], bodies, dt)) continue;
    nameCulprit(report, K::kWord, k, set.items[k].bodies[0]);
    return false;
  }
  return true;
}

bool sweepContacts(World::Impl& world, double dt, StepReport& report) {
  if (!world.settings.contact) return true;
  const double allowance = world.settings.contact->maxSeparationSpeed * dt;
  auto& pairs = world.contacts.pairs;
  report.constraintEvaluations += static_cast<std::int64_t>(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (solve(pairs[k], world.bodies, world.settings.relaxation, allowance)) continue;
    nameCulprit(report, "contact", k, pairs[k].a);
    return false;
  }
  return true;
}

}  // namespace

void prepareConstraints(World::Impl& world, double dt) {
  const bool warm = world.settings.warmStartJoints;
  forEachKind(world.kinds, [&](auto& kind) {
    auto& set = kind.set;
    for (std::size_t k = 0; k < set.items.size(); ++k) {
      if (isDirect(world) && isEquality(set.items[k]))
        continue;  // starts from its last multipliers
      prepare(set.items[k], set.lambda[k], warm, set.tuned[k].split, world.bodies, dt);
    }
  });
  for (ContactPair& pair : world.contacts.pairs)
    prepare(pair, world.bodies, world.settings.warmStart);
}

bool sweep(World::Impl& world, double dt, StepReport& report) {
  const bool joints = !isDirect(world);
  bool finite = true;
  forEachKind(world.kinds, [&](auto& kind) {
    finite = finite && sweepKind(kind, world.bodies, dt, joints, report);
  });
  return finite && sweepContacts(world, dt, report);
}

void nonlinearGaussSeidel(World::Impl& world, double dt, StepReport& report) {
  for (int k = 0; k < world.settings.iterations; ++k) {
    if (k > 0) refreshInertia(world.bodies);
    if (!sweep(world, dt, report)) return;
    ++report.iterations;
  }
}

}  // namespace physics
