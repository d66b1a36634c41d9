// Linear Gauss-Seidel (51).
#include "physics/sweep/linear_gauss_seidel.h"

#include <cmath>

#include "physics/constraints/constraint_solve.h"
#include "physics/sweep/nonlinear_gauss_seidel.h"

namespace physics {
namespace {

FrozenContact direction(const std::array<BodyId, 3>& bodies, const std::array<double, 3>& weight,
                        const std::array<Vec3, 3>& arm, const Vec3& d, const Bodies& state) {
  FrozenContact row;
  row.bodies = bodies;
  for (int b = 0; b < 3; ++b) {
    row.linear[b] = weight[b] * d;
    row.angular[b] = weight[b] * arm[b].cross(d);
    const InverseMass& mass = state.inverse[bodies[b]];
    row.resistance +=
        mass.m * row.linear[b].squaredNorm() + row.angular[b].dot(mass.inertia * row.angular[b]);
  }
  return row;
}

// `gap` and `slip` at X^{t+1}.
FrozenPoint freezePoint(const std::array<BodyId, 3>& bodies, const std::array<double, 3>& weight,
                        const std::array<Vec3, 3>& arm, const Vec3& n, double gap, const Vec3& slip,
                        const Friction& friction, const Bodies& state) {
  FrozenPoint point;
  point.friction = friction;
  const Vec3 t1 = anyNormalTo(n), t2 = n.cross(t1);
  point.rows = {direction(bodies, weight, arm, n, state), direction(bodies, weight, arm, t1, state),
                direction(bodies, weight, arm, t2, state)};
  point.rows[0].c = gap;
  point.rows[1].c = slip.dot(t1);
  point.rows[2].c = slip.dot(t2);
  return point;
}

void freezeContacts(SweepModel& world) {
  const std::vector<Pose>& pose = world.bodies.pose;
  world.linear.points.clear();
  for (const ContactPair& pair : world.contacts.pairs) {
    const Vec3 n = normalOf(pair, pose);
    for (int k = 0; k < pair.count; ++k) {
      const ContactPointState& p = pair.points[k];
      const Vec3 at = pointOf(pair, k, pose);
      const Vec3 dp = (pose[pair.a].x + pose[pair.a].q * p.anchorA) -
                      (pose[pair.b].x + pose[pair.b].q * p.anchorB);
      world.linear.points.push_back(
          freezePoint({pair.a, pair.b, kWorldBody}, {1, -1, 0},
                      {at - pose[pair.a].x, at - pose[pair.b].x, Vec3::Zero()}, n,
                      gapOf(pair, k, pose), dp, pair.friction, world.bodies));
    }
  }
  for (const SoftContact& c : world.softContacts) {
    const Pose& b = pose[c.body];
    const Vec3 n = b.q * c.normal, at = pointOf(c, pose);
    const Vec3 dp = at - (b.x + b.q * c.anchor) - c.startSlip;
    world.linear.points.push_back(freezePoint({c.from, c.to, c.body}, {1 - c.along, c.along, -1},
                                              {Vec3::Zero(), Vec3::Zero(), at - c.radius * n - b.x},
                                              n, gapOf(c, pose), dp, c.friction, world.bodies));
  }
}

void move(const FrozenContact& row, double change, SweepModel& world) {
  for (int b = 0; b < 3; ++b) {
    const InverseMass& mass = world.bodies.inverse[row.bodies[b]];
    world.linear.moved[row.bodies[b]].dx += change * mass.m * row.linear[b];
    world.linear.moved[row.bodies[b]].dtheta += change * (mass.inertia * row.angular[b]);
  }
}

// c_i + (J dX)_i of (51).
double errorOf(const FrozenContact& row, const SweepModel& world) {
  double c = row.c;
  for (int b = 0; b < 3; ++b) {
    const DeltaX& moved = world.linear.moved[row.bodies[b]];
    c += row.linear[b].dot(moved.dx) + row.angular[b].dot(moved.dtheta);
  }
  return c;
}

void sweepPoint(FrozenPoint& point, double xi, SweepModel& world) {
  FrozenContact& normal = point.rows[0];
  if (!(normal.resistance > 0)) return;
  const double next = std::max(normal.total - xi * errorOf(normal, world) / normal.resistance, 0.0);
  move(normal, next - normal.total, world);
  normal.total = next;
  Vec2 friction, before;
  for (int k = 0; k < 2; ++k) {
    const FrozenContact& row = point.rows[k + 1];
    if (!(row.resistance > 0)) return;
    before[k] = row.total;
    friction[k] = row.total - xi * errorOf(row, world) / row.resistance;
  }
  friction *= heldShare(point.friction, friction.norm(), next);  // (101)
  for (int k = 0; k < 2; ++k) {
    move(point.rows[k + 1], friction[k] - before[k], world);
    point.rows[k + 1].total = friction[k];
  }
}

template <class R>
VectorOf<R> nextTotal(const R& frozen, const VectorOf<R>& follow) {
  if constexpr (R::kIsForce) {
    return pushed<R::kRows>(frozen.row.f - frozen.row.k * follow, frozen.row.k, frozen.row.longest,
                            frozen.a, frozen.tuned.relaxation, *frozen.total);
  } else {
    const auto& row = frozen.row;
    VectorOf<R> next = solved<R::kRows>(frozen.form, row.alpha, frozen.a, frozen.tuned,
                                        row.c + follow, *frozen.total);
    clampTotal(next, row.low, row.high, row.longest);
    return next;
  }
}

// The first row whose multiplier would not be finite; rows.size(): none.
template <class R>
std::size_t sweepRows(std::vector<R>& rows, std::vector<DeltaX>& moved) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    R& frozen = rows[k];
    if (!frozen.row.active || !(frozen.a.trace() > 0)) continue;
    const VectorOf<R> next = nextTotal(frozen, along(shapeOf(frozen), frozen.row, moved));
    if (!next.allFinite()) return k;
    const VectorOf<R> change = next - *frozen.total;
    give(shapeOf(frozen), frozen.response, change, moved);
    *frozen.total = next;
  }
  return rows.size();
}

bool sweepKinds(SweepModel& world, StepReport& report) {
  forEachList(world.kinds, world.frozen, [&](auto& rows, const KindPlace& kind) {
    if (report.notFinite) return;
    const std::size_t k = sweepRows(rows, world.linear.moved);
    if (k == rows.size()) return;
    nameCulprit(report, kind.word, k, moverOf(rows[k], world.bodies));
  });
  return !report.notFinite;
}

// The multipliers back to where reports look for them.
void keepTotals(SweepModel& world) {
  std::size_t next = 0;
  const auto take = [&](double& normal, Vec3& friction) {
    const auto& [n, t1, t2] = world.linear.points[next++].rows;
    normal = n.total;
    friction = t1.total * t1.linear[0] + t2.total * t2.linear[0];
  };
  for (ContactPair& pair : world.contacts.pairs) {
    for (int k = 0; k < pair.count; ++k) {
      take(pair.points[k].normalTotal, pair.points[k].frictionTotal);
    }
  }
  for (SoftContact& c : world.softContacts) take(c.normalTotal, c.frictionTotal);
}

}  // namespace

void linearGaussSeidel(SweepModel& world, double dt, StepReport& report) {
  const std::int64_t visits =
      evaluateAll(world.kinds, {world.bodies.pose, world.bodies.start, dt}, world.frozen);
  forEachList(world.kinds, world.frozen, [&](auto& rows, const KindPlace&) {
    for (auto& frozen : rows) {
      if (!frozen.row.active) continue;
      frozen.a = effectiveMassInverse(frozen, frozen.row, world.bodies.inverse, frozen.response);
    }
  });
  freezeContacts(world);
  world.linear.moved.assign(world.bodies.pose.size(), DeltaX{});
  for (int k = 0; k < world.settings.iterations; ++k) {
    if (!sweepKinds(world, report)) return;
    for (FrozenPoint& point : world.linear.points) {
      sweepPoint(point, world.settings.relaxation, world);
    }
    ++report.iterations;
    report.constraintEvaluations += visits + static_cast<std::int64_t>(world.linear.points.size());
  }
  keepTotals(world);
  for (int i = 0; i < world.bodies.size(); ++i) {
    world.bodies.shift[i] += world.linear.moved[i].dx;
    displace(world.bodies.pose[i], world.linear.moved[i].dx, world.linear.moved[i].dtheta);
  }
}

}  // namespace physics
