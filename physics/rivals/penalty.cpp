// Penalty forces: the two steps.
#include <algorithm>
#include <cmath>

#include "physics/constraints/constraint_response.h"
#include "physics/rivals/penalty_springs.h"

namespace physics {
namespace {

template <class F>
void forEachRow(RivalModel& world, F&& f) {
  forEachList(world.kinds, world.frozen, [&](auto& rows, const KindPlace&) {
    for (auto& frozen : rows) f(frozen);
  });
}

// v += M^-1 J^T f h, and the totals where reports look for them.
void pushAll(RivalModel& world, double dt) {
  std::vector<Velocity>& velocity = world.bodies.velocity;
  forEachRow(world, [&](auto& frozen) {
    frozen.total->setZero();
    if (!frozen.row.active) return;
    *frozen.total = frozen.f;
    for (std::size_t b = 0; b < frozen.bodies.size(); ++b) {
      const DeltaX step = displacementOf(shapeOf(frozen), frozen.response, b, frozen.f);
      velocity[frozen.bodies[b]].v += step.dx / dt;
      velocity[frozen.bodies[b]].w += step.dtheta / dt;
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

// The geometric stiffness of the last substep's force, where it stiffens; by the shape of the row:
// one row between two points or along many, or several rows between two points.
template <class R>
void addGeometric(const R& frozen, RivalModel& world) {
  if (!frozen.isLinear) return;
  const auto armOf = [&](std::size_t b) -> Vec3 {
    return world.bodies.pose[frozen.bodies[b]].q * frozen.anchors[b];
  };
  const VectorOf<R>& total = *frozen.total;
  if constexpr (R::kBodies == kMany) {
    for (std::size_t b = 0; b + 1 < frozen.bodies.size(); ++b) {
      addTension({frozen.bodies[b], frozen.bodies[b + 1]}, {Vec3::Zero(), Vec3::Zero()}, -total[0],
                 world);
    }
  } else if constexpr (R::kBodies == 2 && R::kRows == 1) {
    addTension(frozen.bodies, {armOf(0), armOf(1)}, -total[0], world);
  } else if constexpr (R::kBodies == 2) {
    for (std::size_t b = 0; b < 2 && frozen.isAnchored; ++b) {
      addPull(frozen.bodies[b], armOf(b), frozen.row.linear[b].transpose() * total, world);
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
  forEachRow(world, [&](auto& frozen) {
    const auto& row = frozen.row;
    if (!row.active) return;
    for (std::size_t b = 0; b < frozen.bodies.size(); ++b) {
      Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
      if (frozen.isLinear) linear = row.linear[b].transpose() * frozen.f / dt;
      if (frozen.isAngular) angular = row.angular[b].transpose() * frozen.f / dt;
      matrix.addImpulse(frozen.bodies[b], linear, angular);
    }
    const auto* angular = frozen.isAngular ? &row.angular : nullptr;
    matrix.template addStiffness<std::decay_t<decltype(frozen)>::kRows>(frozen.bodies, row.linear,
                                                                        angular, frozen.k);
    addGeometric(frozen, world);
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
  forEachList(world.kinds, world.frozen, [&](const auto& rows, const KindPlace& kind) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (!rows[k].row.active) continue;
      offer(kind.word, k, moverOf(rows[k], world.bodies), rows[k].k.norm());
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
  forEachRow(world, [&](auto& frozen) {
    frozen.total->setZero();
    if (!frozen.row.active) return;
    *frozen.total = frozen.f - frozen.k * along(shapeOf(frozen), frozen.row, world.penalty.step);
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
