// Linear Gauss-Seidel (51).
#include "physics/sweep/linear_gauss_seidel.h"

#include <cmath>

#include "physics/constraints/friction.h"
#include "physics/sweep/nonlinear_gauss_seidel.h"

namespace physics {
namespace {

template <class C>
std::vector<FrozenRow<C>>& rowsOf(SweepModel& world) {
  return std::get<std::vector<FrozenRow<C>>>(world.linear.rows);
}

template <class C>
void freeze(const Set<C>& set, const Bodies& bodies, double dt, std::vector<FrozenRow<C>>& rows) {
  rows.resize(set.items.size());
  for (std::size_t k = 0; k < set.items.size(); ++k) {
    rows[k].at.row.active = true;
    set.items[k].evaluate({bodies.pose, bodies.start, dt}, rows[k].at.row);
    if (!rows[k].at.row.active) continue;
    rows[k].a =
        effectiveMassInverse(set.items[k], rows[k].at.row, bodies.inverse, rows[k].at.response);
  }
}

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

// The first row whose multiplier would not be finite; rows.size(): none.
template <class C>
std::size_t sweepRows(Set<C>& set, std::vector<FrozenRow<C>>& rows, std::vector<DeltaX>& moved) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    auto& [row, response] = rows[k].at;
    if (!row.active || !(rows[k].a.trace() > 0)) continue;
    const C& item = set.items[k];
    typename Set<C>::Vector& total = set.lambda[k].total;
    const typename Set<C>::Vector follow = along(item, row, moved);
    typename Set<C>::Vector next;
    if constexpr (Force<C>) {
      Evaluated<C> push = row;
      push.f -= row.k * follow;
      next = pushed<C>(push, rows[k].a, set.tuned[k].relaxation, total);
    } else {
      next = solved(item, row, rows[k].a, set.tuned[k], (row.c + follow).eval(), total);
    }
    if (!next.allFinite()) return k;
    for (std::size_t b = 0; b < item.bodies.size(); ++b) {
      const DeltaX step = displacementOf<C>(response, b, next - total);
      moved[item.bodies[b]].dx += step.dx;
      moved[item.bodies[b]].dtheta += step.dtheta;
    }
    total = next;
  }
  return rows.size();
}

bool sweepKinds(SweepModel& world, StepReport& report) {
  forEachKind(world.kinds, [&](auto& kind) {
    using K = std::decay_t<decltype(kind)>;
    if (report.notFinite) return;
    const std::size_t k = sweepRows(kind.set, rowsOf<typename K::Item>(world), world.linear.moved);
    if (k == kind.set.items.size()) return;
    nameCulprit(report, K::kWord, k, moverOf(kind.set.items[k], world.bodies));
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
  std::int64_t visits = 0;
  forEachKind(world.kinds, [&](auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    freeze(kind.set, world.bodies, dt, rowsOf<C>(world));
    visits += static_cast<std::int64_t>(kind.set.items.size());
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
