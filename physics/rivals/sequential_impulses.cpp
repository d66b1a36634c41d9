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

// Soft by itself: taken once per substep, and not relaxed.
template <class R>
bool isCompliant(const R& frozen) {
  if constexpr (R::kIsForce) {
    return true;
  } else {
    return frozen.row.alpha > 0;
  }
}

// J and A at the present poses. A force is linear about the poses `ahead`, where v would take the
// bodies: its damping needs a velocity, and f there + K J (h v) is what lambda + K J (h v) must be.
template <class R>
void freeze(RivalModel& world, const KindPlace& kind, std::size_t k, double dt, R& frozen) {
  const std::vector<Pose>& pose = world.bodies.pose;
  evaluate(world.kinds, kind.place, k, {pose, pose, dt}, frozen);
  if constexpr (R::kIsForce) {
    evaluateForce(world.kinds, kind.place, k, {world.ahead, pose, dt}, frozen);
    frozen.row.f += frozen.row.k * along(shapeOf(frozen), frozen.row, world.impulses.moved);
  }
  if (!frozen.row.active) return;
  frozen.a = effectiveMassInverse(frozen, frozen.row, world.bodies.inverse, frozen.response);
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
  forEachList(world.kinds, world.frozen, [&](auto& rows, const KindPlace& kind) {
    rows.resize(kind.count);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (stage == Stage::kRelax && isCompliant(rows[k])) continue;
      freeze(world, kind, k, dt, rows[k]);
    }
  });
  freezeTouches(world, report);
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

void warmStart(RivalModel& world) {
  forEachList(world.kinds, world.frozen, [&](auto& rows, const KindPlace&) {
    for (auto& frozen : rows) {
      if (!frozen.row.active) frozen.total->setZero();
      if (frozen.total->isZero(0)) continue;
      give(shapeOf(frozen), frozen.response, *frozen.total, std::span(world.impulses.moved));
    }
  });
  for (ImpulseTouch& contact : world.impulses.touches) {
    *contact.friction -= contact.friction->dot(contact.touch.n) * contact.touch.n;
    give(contact, contact.rows[0], *contact.normal, world.impulses.moved);
    for (int k = 1; k < 3; ++k) {
      give(contact, contact.rows[k], contact.friction->dot(contact.rows[k].d),
           world.impulses.moved);
    }
  }
}

// The new total; `follow` is J (h v).
template <class R>
VectorOf<R> nextTotal(const R& frozen, Softness soft, Stage stage, const VectorOf<R>& follow) {
  using Vector = VectorOf<R>;
  const auto& row = frozen.row;
  const double xi = frozen.tuned.relaxation;
  if constexpr (R::kIsForce) {
    return pushed<R::kRows>(row.f - row.k * follow, row.k, row.longest, frozen.a, xi,
                            *frozen.total);
  } else {
    const double extra = frozen.tuned.regularisation * frozen.a.trace() / R::kRows;
    const double alpha = row.alpha + extra;
    Vector standing = standingError<R>(row);
    if (!frozen.stands || row.alpha > 0) standing.setZero();
    const Vector rest = row.c - standing, total = *frozen.total;
    const bool isSoft = stage == Stage::kSolve && frozen.stands && row.alpha == 0 && rest.isZero(0);
    if (!isSoft) soft = {};
    const Vector residual = follow + rest + soft.rate * standing + alpha * total;
    Vector next = total + soft.mass * step<R::kRows>(frozen.a, alpha, xi, Form::kVector, residual) -
                  soft.impulse * total;
    clampTotal(next, row.low, row.high, row.longest);
    return next;
  }
}

// The first row whose multiplier would not be finite; rows.size(): none.
template <class R>
std::size_t sweepRows(std::vector<R>& rows, Softness soft, Stage stage,
                      std::vector<DeltaX>& moved) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    R& frozen = rows[k];
    if (!frozen.row.active || !(frozen.a.trace() > 1e-300)) continue;
    const VectorOf<R> next =
        nextTotal(frozen, soft, stage, along(shapeOf(frozen), frozen.row, moved));
    if (!next.allFinite()) return k;
    const VectorOf<R> change = next - *frozen.total;
    give(shapeOf(frozen), frozen.response, change, moved);
    *frozen.total = next;
  }
  return rows.size();
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
  forEachList(world.kinds, world.frozen, [&](auto& rows, const KindPlace& kind) {
    if (!finite) return;
    report.constraintEvaluations += static_cast<std::int64_t>(rows.size());
    const std::size_t k = sweepRows(rows, stiff.joint, stage, world.impulses.moved);
    finite = k == rows.size();
    if (!finite) nameCulprit(report, kind.word, k, moverOf(rows[k], world.bodies));
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
