// Penalty forces: the two steps.
#include <algorithm>
#include <cmath>

#include "physics/rivals/penalty_springs.h"

namespace physics {
namespace {

template <class F>
void forEachRow(RivalModel& world, F&& f) {
  forEachKind(world.kinds, [&](auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    auto& set = kind.set;
    for (std::size_t k = 0; k < set.items.size(); ++k) {
      f(set.items[k], set.lambda[k].total, stiffRowsOf<C>(world)[k]);
    }
  });
}

// v += M^-1 J^T f h, and the totals where reports look for them.
void pushAll(RivalModel& world, double dt) {
  std::vector<Velocity>& velocity = world.bodies.velocity;
  forEachRow(world, [&](auto& item, auto& total, auto& stiff) {
    using C = std::decay_t<decltype(item)>;
    total.setZero();
    if (!stiff.at.row.active) return;
    total = stiff.f;
    for (std::size_t b = 0; b < item.bodies.size(); ++b) {
      const DeltaX step = displacementOf<C>(stiff.at.response, b, stiff.f);
      velocity[item.bodies[b]].v += step.dx / dt;
      velocity[item.bodies[b]].w += step.dtheta / dt;
    }
  });
  for (const StiffTouch& contact : world.penalty.touches) {
    *contact.normal = contact.f[0];
    for (int k = 0; k < 3; ++k) push(contact.touch, contact.rows[k], contact.f[k] / dt, velocity);
  }
}

// T (1 - d d^T)/l of a tension T between two points: it resists going sideways.
void addTension(const std::array<BodyId, 2>& ids, const std::array<Vec3, 2>& arms, double tension,
                RivalModel& world) {
  const Vec3 dp = world.bodies.pose[ids[0]].x + arms[0] - world.bodies.pose[ids[1]].x - arms[1];
  const double length2 = dp.squaredNorm();
  if (!(tension > 0) || length2 < 1e-24) return;
  const Mat3 k = tension / std::sqrt(length2) * (Mat3::Identity() - dp * dp.transpose() / length2);
  const std::array<Mat3, 2> linear{Mat3::Identity(), -Mat3::Identity()};
  const std::array<Mat3, 2> angular{-skew(arms[0]), skew(arms[1])};
  world.penalty.matrix.addStiffness<3>(ids, linear, &angular, k);
}

// A force F that pulls at the end of an arm r turns the body towards itself: (F.r)(1 - r r^T/r^2).
void addPull(BodyId body, const Vec3& arm, const Vec3& force, RivalModel& world) {
  const double along = force.dot(arm);
  if (!(along > 0)) return;
  const std::array<BodyId, 1> ids{body};
  const std::array<Mat3, 1> linear{Mat3::Zero()}, angular{Mat3::Identity()};
  const Mat3 k = along * (Mat3::Identity() - arm * arm.transpose() / arm.squaredNorm());
  world.penalty.matrix.addStiffness<3>(ids, linear, &angular, k);
}

template <class C>
Vec3 armOf(const C& item, std::size_t b, const Bodies& bodies) {
  if constexpr (requires { item.anchors; }) {
    return bodies.pose[item.bodies[b]].q * item.anchors[b];
  } else {
    return Vec3::Zero();
  }
}

// The geometric stiffness of the last substep's force, where it stiffens; by the shape of the row:
// one row between two points or along many, or three rows between two points.
template <class C>
void addGeometric(const C& item, const Evaluated<C>& row, const typename Set<C>::Vector& total,
                  RivalModel& world) {
  if constexpr (C::kLinear && C::kBodies == kMany) {
    for (std::size_t b = 0; b + 1 < item.bodies.size(); ++b) {
      addTension({item.bodies[b], item.bodies[b + 1]}, {Vec3::Zero(), Vec3::Zero()}, -total[0],
                 world);
    }
  } else if constexpr (C::kLinear && C::kBodies == 2 && C::kRows == 1) {
    addTension(item.bodies, {armOf(item, 0, world.bodies), armOf(item, 1, world.bodies)}, -total[0],
               world);
  } else if constexpr (C::kLinear && C::kBodies == 2 && requires { item.anchors; }) {
    for (std::size_t b = 0; b < 2; ++b) {
      addPull(item.bodies[b], armOf(item, b, world.bodies), row.linear[b].transpose() * total,
              world);
    }
  }
}

void assembleTouches(RivalModel& world, double dt) {
  for (const StiffTouch& contact : world.penalty.touches) {
    const Touch& touch = contact.touch;
    std::array<Mat3, 3> linear, angular;
    for (int b = 0; b < touch.count; ++b) {
      for (int k = 0; k < 3; ++k) {
        const Vec3& d = contact.rows[k].d;
        linear[b].row(k) = touch.weight[b] * d.transpose();
        angular[b].row(k) = touch.weight[b] * touch.arm[b].cross(d).transpose();
      }
      world.penalty.matrix.addImpulse(touch.bodies[b], linear[b].transpose() * contact.f / dt,
                                      angular[b].transpose() * contact.f / dt);
    }
    const std::span<const BodyId> ids(touch.bodies.data(), static_cast<std::size_t>(touch.count));
    world.penalty.matrix.addStiffness<3>(ids, linear, &angular, contact.k.asDiagonal());
  }
}

// (M + J^T K J + geometric) dv = M (free - v) + J^T f h
void assemble(RivalModel& world, double dt) {
  SparseMotion& matrix = world.penalty.matrix;
  matrix.begin(world.bodies, world.penalty.free);
  forEachRow(world, [&](auto& item, auto& total, auto& stiff) {
    using C = std::decay_t<decltype(item)>;
    const auto& row = stiff.at.row;
    if (!row.active) return;
    for (std::size_t b = 0; b < item.bodies.size(); ++b) {
      Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
      if constexpr (C::kLinear) linear = row.linear[b].transpose() * stiff.f / dt;
      if constexpr (isAngular<C>()) angular = row.angular[b].transpose() * stiff.f / dt;
      matrix.addImpulse(item.bodies[b], linear, angular);
    }
    const auto* angular = isAngular<C>() ? &row.angular : nullptr;
    matrix.template addStiffness<C::kRows>(item.bodies, row.linear, angular, stiff.k);
    addGeometric(item, row, total, world);
  });
  assembleTouches(world, dt);
}

// Whether contacts stick, after a solve: the force it took against Coulomb's bound, and a slide
// that would turn round has come to rest.
void judgeFriction(RivalModel& world, const std::vector<DeltaX>& change) {
  for (StiffTouch& contact : world.penalty.touches) {
    const Vec3 before = followOf(contact, world.penalty.moved), more = followOf(contact, change);
    const Friction& friction = contact.touch.friction;
    contact.f -= contact.k.cwiseProduct(more);
    contact.f[0] = std::max(contact.f[0], 0.0);
    const double length = contact.f.tail<2>().norm();
    const bool breaks = length > friction.staticCoefficient * contact.f[0];
    const Vec3 after = before + more;
    if (contact.point != nullptr) {
      contact.point->sticking =
          contact.sliding ? contact.stopped || before.tail<2>().dot(after.tail<2>()) <= 0 : !breaks;
    }
    if (breaks) contact.f.tail<2>() *= friction.dynamicCoefficient * contact.f[0] / length;
  }
}

// One Newton step of backward Euler. False: the system broke down.
bool newtonStep(RivalModel& world, double dt) {
  PenaltySystem& s = world.penalty;
  assemble(world, dt);
  s.change.resize(world.bodies.pose.size());
  if (!s.matrix.solve(s.change)) return false;
  std::vector<DeltaX>& change = s.step;
  change.resize(s.change.size());
  for (std::size_t i = 0; i < s.change.size(); ++i) {
    change[i] = {dt * s.change[i].v, dt * s.change[i].w};
    world.bodies.velocity[i].v += s.change[i].v;
    world.bodies.velocity[i].w += s.change[i].w;
  }
  judgeFriction(world, change);
  return true;
}

// Who is named where the system broke down.
void nameStiffest(RivalModel& world, StepReport& report) {
  double most = -1;
  const auto offer = [&](const char* kind, std::size_t k, BodyId body, double stiffness) {
    if (!std::isfinite(most) || stiffness <= most) return;
    most = stiffness;
    nameCulprit(report, kind, k, body);
  };
  forEachKind(world.kinds, [&](auto& kind) {
    using K = std::decay_t<decltype(kind)>;
    for (std::size_t k = 0; k < kind.set.items.size(); ++k) {
      const auto& stiff = stiffRowsOf<typename K::Item>(world)[k];
      if (!stiff.at.row.active) continue;
      offer(K::kWord, k, moverOf(kind.set.items[k], world.bodies), stiff.k.norm());
    }
  });
  for (std::size_t k = 0; k < world.penalty.touches.size(); ++k) {
    const StiffTouch& contact = world.penalty.touches[k];
    offer("contact point", k, contact.touch.bodies[0], contact.k.norm());
  }
  if (!report.notFinite) nameCulprit(report, "all springs together", 0, kWorldBody);
}

// lambda of the last Newton step, where reports and the next substep look for it.
void keepTotals(RivalModel& world) {
  forEachRow(world, [&](auto& item, auto& total, auto& stiff) {
    total.setZero();
    if (!stiff.at.row.active) return;
    total = stiff.f - stiff.k * along(item, stiff.at.row, world.penalty.step);
  });
  for (const StiffTouch& contact : world.penalty.touches) {
    *contact.normal = contact.f[0];
    *contact.friction = contact.f[1] * contact.rows[1].d + contact.f[2] * contact.rows[2].d;
  }
}

}  // namespace

void penaltyExplicit(RivalModel& world, double dt, StepReport& report) {
  const PenaltyScheme scheme = schemeOf(world.settings, false);
  takeMoved(world, dt);
  world.ahead = world.bodies.pose;  // where the bodies came from: dampers look at the way since
  for (int i = 0; i < world.bodies.size(); ++i) {
    displace(world.ahead[i], -world.penalty.moved[i].dx, -world.penalty.moved[i].dtheta);
  }
  if (!takeSprings(world, {world.bodies.pose, world.ahead, dt}, scheme, true, report)) return;
  accelerate(world, dt, Gyroscopic::kExplicit);
  pushAll(world, dt);
  ++report.iterations;
  bounce(world, dt);
  advance(world.bodies, dt);
}

void penalty(RivalModel& world, double dt, StepReport& report) {
  const PenaltyScheme scheme = schemeOf(world.settings, true);
  accelerate(world, dt, Gyroscopic::kImplicit);
  checkFinite(world, report);
  if (report.notFinite) return;
  world.penalty.free = world.bodies.velocity;
  for (int k = 0; k < world.settings.iterations; ++k) {
    takeMoved(world, dt);
    advance(world.bodies, dt);
    const Configuration x{world.bodies.pose, world.bodies.start, dt};
    if (!takeSprings(world, x, scheme, k == 0, report)) return;
    if (!newtonStep(world, dt)) return nameStiffest(world, report);
    ++report.iterations;
  }
  keepTotals(world);
  advance(world.bodies, dt);
  bounce(world, dt);
}

}  // namespace physics
