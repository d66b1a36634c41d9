// Sequential impulses.
#include "physics/rivals/sequential_impulses.h"

#include <cmath>

#include "physics/constraints/constraint_solve.h"
#include "physics/constraints/friction.h"
#include "physics/rivals/rival.h"

namespace physics {
namespace {

enum class Stage { kSolve, kRelax };

struct Softness {
  double rate = 0;     // h b
  double mass = 1;     // m_s
  double impulse = 0;  // i_s
};

Softness softness(double hertz, double zeta, double dt) {
  const double omega = 2 * kPi * hertz, damped = 2 * zeta + dt * omega, a = dt * omega * damped;
  return {dt * omega / damped, a / (1 + a), 1 / (1 + a)};
}

// Frequencies and damping ratios of Solver2D; no more than a quarter of the step's.
struct Stiffness {
  Softness joint, contact, fixedContact;
};
Stiffness stiffness(double dt) {
  const double most = 0.25 / dt, contact = std::min(30.0, most);
  return {softness(std::min(60.0, most), 2, dt), softness(contact, 10, dt),
          softness(2 * contact, 10, dt)};
}

template <class C>
std::vector<ImpulseRow<C>>& rowsOf(RivalModel& world) {
  return std::get<std::vector<ImpulseRow<C>>>(world.impulses.rows);
}

// Soft by itself: taken once per substep, and not relaxed.
template <class C>
bool isCompliant(const Evaluated<C>& row) {
  if constexpr (Force<C>) {
    return true;
  } else {
    return row.alpha > 0;
  }
}

// J and A at the present poses. A force is linear about the poses `ahead`, where v would take the
// bodies: its damping needs a velocity, and f there + K J (h v) is what lambda + K J (h v) must be.
template <class C>
void freeze(const Set<C>& set, RivalModel& world, double dt, Stage stage) {
  std::vector<ImpulseRow<C>>& rows = rowsOf<C>(world);
  const std::vector<Pose>& pose = world.bodies.pose;
  rows.resize(set.items.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    auto& [row, response] = rows[k].at;
    if (stage == Stage::kRelax && isCompliant<C>(row)) continue;
    evaluateAt(set.items[k], {pose, pose, dt}, row);
    if constexpr (Force<C>) {
      Evaluated<C> there;
      set.items[k].evaluate({world.ahead, pose, dt}, there);
      row.active = row.active && there.active;
      row.k = there.k;
      row.longest = there.longest;
      row.f = there.f + row.k * along(set.items[k], row, world.impulses.moved);
    }
    if (row.active)
      rows[k].a = effectiveMassInverse(set.items[k], row, world.bodies.inverse, response);
  }
}

void freezeTouches(RivalModel& world, StepReport& report) {
  world.impulses.touches.clear();
  forEachTouch(world, report, [&](const Touch& touch, double& normal, Vec3& friction, auto*) {
    const Vec3 t1 = anyNormalTo(touch.n), t2 = touch.n.cross(t1);
    const auto& inverse = world.bodies.inverse;
    ImpulseTouch frozen{
        touch,
        {rowOf(touch, touch.n, inverse), rowOf(touch, t1, inverse), rowOf(touch, t2, inverse)},
        inverse[touch.bodies[0]].m == 0 || inverse[touch.bodies[1]].m == 0,
        &normal,
        &friction};
    world.impulses.touches.push_back(frozen);
    return true;
  });
}

void freezeAll(RivalModel& world, double dt, Stage stage, StepReport& report) {
  forEachKind(world.kinds, [&](auto& kind) { freeze(kind.set, world, dt, stage); });
  freezeTouches(world, report);
}

template <class C>
void give(const C& item, const Response<C>& response, const typename Set<C>::Vector& change,
          std::vector<DeltaX>& moved) {
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const DeltaX step = displacementOf<C>(response, b, change);
    moved[item.bodies[b]].dx += step.dx;
    moved[item.bodies[b]].dtheta += step.dtheta;
  }
}

void give(const ImpulseTouch& contact, const TouchRow& row, double change,
          std::vector<DeltaX>& moved) {
  for (int b = 0; b < contact.touch.count; ++b) {
    moved[contact.touch.bodies[b]].dx += change * row.linear[b];
    moved[contact.touch.bodies[b]].dtheta += change * row.turn[b];
  }
}

double alongRow(const Touch& touch, const TouchRow& row, const std::vector<DeltaX>& moved) {
  double sum = 0;
  for (int b = 0; b < touch.count; ++b) {
    const DeltaX& body = moved[touch.bodies[b]];
    sum += touch.weight[b] * row.d.dot(body.dx + body.dtheta.cross(touch.arm[b]));
  }
  return sum;
}

template <class C>
void warmStartRows(Set<C>& set, RivalModel& world) {
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    auto& [row, response] = rowsOf<C>(world)[k].at;
    typename Set<C>::Vector& total = set.lambda[k].total;
    if (!row.active) total.setZero();
    if (!total.isZero(0)) give(set.items[k], response, total, world.impulses.moved);
  }
}

void warmStart(RivalModel& world) {
  forEachKind(world.kinds, [&](auto& kind) { warmStartRows(kind.set, world); });
  for (ImpulseTouch& contact : world.impulses.touches) {
    *contact.friction -= contact.friction->dot(contact.touch.n) * contact.touch.n;
    give(contact, contact.rows[0], *contact.normal, world.impulses.moved);
    for (int k = 1; k < 3; ++k) {
      give(contact, contact.rows[k], contact.friction->dot(contact.rows[k].d),
           world.impulses.moved);
    }
  }
}

// The new total of a constraint; `follow` is J (h v).
template <class C>
typename Set<C>::Vector nextTotal(const Evaluated<C>& row,
                                  const typename Gradients<C::kBodies, C::kRows>::Matrix& a,
                                  const typename Set<C>::Tuned& tuned, Softness soft, Stage stage,
                                  const typename Set<C>::Vector& follow,
                                  const typename Set<C>::Vector& total) {
  using Vector = typename Set<C>::Vector;
  const double xi = tuned.relaxation, extra = tuned.regularisation * a.trace() / C::kRows;
  const double alpha = row.alpha + extra;
  Vector standing = standingError<C>(row);
  if (!canStand<C>() || row.alpha > 0) standing.setZero();
  const Vector rest = row.c - standing;
  const bool isSoft = stage == Stage::kSolve && canStand<C>() && row.alpha == 0 && rest.isZero(0);
  if (!isSoft) soft = {};
  const Vector residual = follow + rest + soft.rate * standing + alpha * total;
  Vector next = total + soft.mass * step<C::kRows>(a, alpha, xi, Form::kVector, residual) -
                soft.impulse * total;
  clampTotal(next, row.low, row.high, row.longest);
  return next;
}

template <class K>
bool sweepKind(K& kind, RivalModel& world, Softness soft, Stage stage, StepReport& report) {
  using C = typename K::Item;
  auto& set = kind.set;
  std::vector<DeltaX>& moved = world.impulses.moved;
  report.constraintEvaluations += static_cast<std::int64_t>(set.items.size());
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    const auto& [row, response] = rowsOf<C>(world)[k].at;
    const auto& a = rowsOf<C>(world)[k].a;
    if (!row.active || !(a.trace() > 1e-300)) continue;
    const typename Set<C>::Vector follow = along(set.items[k], row, moved);
    typename Set<C>::Vector& total = set.lambda[k].total;
    typename Set<C>::Vector next;
    if constexpr (Force<C>) {
      Evaluated<C> push = row;
      push.f -= row.k * follow;
      next = pushed<C>(push, a, set.tuned[k].relaxation, total);
    } else {
      next = nextTotal<C>(row, a, set.tuned[k], soft, stage, follow, total);
    }
    if (!next.allFinite()) {
      nameCulprit(report, K::kWord, k, moverOf(set.items[k], world.bodies));
      return false;
    }
    give(set.items[k], response, next - total, moved);
    total = next;
  }
  return true;
}

void sweepNormal(const ImpulseTouch& contact, const Stiffness& stiff, Stage stage, double fastest,
                 std::vector<DeltaX>& moved) {
  const TouchRow& row = contact.rows[0];
  const double gap = contact.touch.gap;
  Softness soft;
  if (stage == Stage::kSolve && gap <= 0)
    soft = contact.onFixed ? stiff.fixedContact : stiff.contact;
  const double bias = gap > 0 ? gap : std::max(soft.rate * gap, -fastest);
  const double residual = alongRow(contact.touch, row, moved) + bias;
  const double total = *contact.normal;
  *contact.normal =
      std::max((1 - soft.impulse) * total - soft.mass * residual / row.resistance, 0.0);
  give(contact, row, *contact.normal - total, moved);
}

// Both rows, and then Coulomb's bound on their sum (101).
void sweepFriction(const ImpulseTouch& contact, std::vector<DeltaX>& moved) {
  Vec3& total = *contact.friction;
  Vec2 before, next;
  for (int k = 0; k < 2; ++k) {
    const TouchRow& row = contact.rows[k + 1];
    if (!(row.resistance > 1e-300)) return;
    before[k] = total.dot(row.d);
    next[k] = before[k] - alongRow(contact.touch, row, moved) / row.resistance;
  }
  next *= heldShare(contact.touch.friction, next.norm(), *contact.normal);
  total = next[0] * contact.rows[1].d + next[1] * contact.rows[2].d;
  for (int k = 0; k < 2; ++k) give(contact, contact.rows[k + 1], next[k] - before[k], moved);
}

bool sweep(RivalModel& world, double dt, Stage stage, StepReport& report) {
  const Stiffness stiff = stiffness(dt);
  bool finite = true;
  forEachKind(world.kinds, [&](auto& kind) {
    finite = finite && sweepKind(kind, world, stiff.joint, stage, report);
  });
  report.constraintEvaluations += contactVisits(world);
  for (const ImpulseTouch& contact : world.impulses.touches) {
    if (!(contact.rows[0].resistance > 1e-300)) continue;
    sweepNormal(contact, stiff, stage, world.settings.contact->maxSeparationSpeed * dt,
                world.impulses.moved);
    sweepFriction(contact, world.impulses.moved);
  }
  ++report.iterations;
  return finite;
}

void takeMovedAndAhead(RivalModel& world, double dt) {
  world.impulses.moved.resize(world.bodies.pose.size());
  world.ahead = world.bodies.pose;
  for (int i = 0; i < world.bodies.size(); ++i) {
    const Velocity& velocity = world.bodies.velocity[i];
    world.impulses.moved[i] = {dt * velocity.v, dt * velocity.w};
    displace(world.ahead[i], dt * velocity.v, dt * velocity.w);
  }
}

void giveVelocities(RivalModel& world, double dt) {
  for (int i = 0; i < world.bodies.size(); ++i) {
    if (world.bodies.motion[i] != Motion::kDynamic) continue;
    const DeltaX& moved = world.impulses.moved[i];
    world.bodies.velocity[i] = {moved.dx / dt, moved.dtheta / dt};
  }
}

bool sweepAll(RivalModel& world, double dt, Stage stage, StepReport& report) {
  bool finite = true;
  for (int k = 0; k < world.settings.iterations && finite; ++k) {
    finite = sweep(world, dt, stage, report);
  }
  giveVelocities(world, dt);
  return finite;
}

}  // namespace

void sequentialImpulses(RivalModel& world, double dt, StepReport& report) {
  accelerate(world, dt, Gyroscopic::kImplicit);
  takeMovedAndAhead(world, dt);
  freezeAll(world, dt, Stage::kSolve, report);
  warmStart(world);
  if (!sweepAll(world, dt, Stage::kSolve, report)) return;
  advance(world.bodies, dt);
  refreshInertia(world.bodies);
  freezeAll(world, dt, Stage::kRelax, report);
  if (!sweepAll(world, dt, Stage::kRelax, report)) return;
  bounce(world, dt);
}

}  // namespace physics
