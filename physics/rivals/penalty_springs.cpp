// Penalty forces: the springs of all constraints and contacts.
#include "physics/rivals/penalty_springs.h"

#include <Eigen/LU>
#include <cmath>

#include "physics/constraints/constraint_solve.h"
#include "physics/constraints/friction.h"

namespace physics {
namespace {

// How many constraints share a body: the share of each in the stiffness that explicit steps bear.
double sharers(const RivalModel& world, std::span<const BodyId> bodies) {
  int most = 1;
  for (const BodyId body : bodies) {
    if (world.bodies.inverse[body].m > 0) most = std::max(most, world.penalty.meeting[body]);
  }
  return most;
}

void countMeetings(RivalModel& world, StepReport& report) {
  std::vector<int>& meeting = world.penalty.meeting;
  meeting.assign(world.bodies.pose.size(), 0);
  forEachList(world.kinds, world.frozen, [&](const auto& rows, const KindPlace&) {
    for (const auto& frozen : rows) {
      if (frozen.kIsForce) continue;
      for (const BodyId body : frozen.bodies) ++meeting[body];
    }
  });
  forEachTouch(world, report, [&](const Touch& touch, auto&, auto&, auto*) {
    for (int b = 0; touch.gap < 0 && b < touch.count; ++b) meeting[touch.bodies[b]] += 2;
    return true;
  });
}

// f and k of a constraint: the wrong part of its error against the springs, its bounds on the
// force.
template <class R>
void stiffen(const PenaltyScheme& scheme, double share, const VectorOf<R>& follow, R& frozen) {
  using Matrix = MatrixOf<R>;
  const auto& row = frozen.row;
  const VectorOf<R> standing = standingError<R>(row);
  frozen.k.setZero();
  frozen.f.setZero();
  if (standing.isZero(0) && (row.high <= 0 || row.low >= 0)) return;  // an inequality that holds
  Matrix soft = (share / scheme.kappa) * frozen.a;  // in series with its own compliance
  soft.diagonal().array() += row.alpha + 1e-12 * frozen.a.trace() / scheme.kappa;
  const Matrix k = soft.inverse();
  const Matrix d = frozen.stands ? Matrix(scheme.delta / scheme.kappa * k) : Matrix::Zero();
  frozen.f = -(k * standing) - d * follow;
  VectorOf<R> bounded = frozen.f;
  clampTotal(bounded, row.low, row.high, row.longest);
  if (bounded == frozen.f) frozen.k = k + d;
  frozen.f = bounded;
}

// False: it is not finite.
template <class R>
bool takeSpring(const PenaltyScheme& scheme, const RivalModel& world, R& frozen) {
  auto& row = frozen.row;
  if (!frozen.isLinear) {
    for (auto& block : row.linear) block.setZero();
  }
  if (!row.active) return true;
  frozen.a = effectiveMassInverse(frozen, row, world.bodies.inverse, frozen.response);
  row.active = frozen.a.trace() > 1e-300;
  if (!row.active) return std::isfinite(frozen.a.trace());
  if constexpr (R::kIsForce) {
    const double size = row.f.norm(), share = size > row.longest ? row.longest / size : 1;
    frozen.f = share * row.f;
    frozen.k = share * row.k;
  } else {
    const double share = scheme.implicit ? 1 : sharers(world, frozen.bodies);
    stiffen(scheme, share, along(shapeOf(frozen), row, world.penalty.moved), frozen);
  }
  return frozen.f.allFinite();
}

bool takeRows(RivalModel& world, const PenaltyScheme& scheme, StepReport& report) {
  bool finite = true;
  forEachList(world.kinds, world.frozen, [&](auto& rows, const KindPlace& kind) {
    for (std::size_t k = 0; k < rows.size() && finite; ++k) {
      finite = takeSpring(scheme, world, rows[k]);
      if (!finite) nameCulprit(report, kind.word, k, moverOf(rows[k], world.bodies));
    }
  });
  return finite;
}

// Explicit steps know the normal force: the tangential spring is cut to its bound.
void rubExplicitly(const Vec2& stretched, const Vec2& damped, StiffTouch& contact) {
  const double normal = contact.f[0], length = (stretched + damped).norm();
  const Friction& friction = contact.touch.friction;
  contact.sliding = length > friction.staticCoefficient * normal;
  const double share = heldShare(friction, length, normal);
  contact.f.tail<2>() = share * (stretched + damped);
  *contact.friction = share * (stretched[0] * contact.rows[1].d + stretched[1] * contact.rows[2].d);
}

// Implicit steps guess it. Whether the contact sticks was seen after the last solve: a stiff damper
// holds it, without a memory, for it hardly slips. A sliding one takes nu_d lambda_n of the guess,
// or where that is more than would stop it alone, a damper that cannot drive.
void rubImplicitly(double normal, const Vec2& follow, StiffTouch& contact) {
  const Friction& friction = contact.touch.friction;
  const double size = follow.norm();
  const double damper = 1 / std::max(contact.rows[1].resistance, contact.rows[2].resistance);
  const double rubs = friction.dynamicCoefficient * normal;
  const bool sticks = contact.point != nullptr
                          ? contact.point->sticking
                          : damper * size <= friction.staticCoefficient * normal;
  contact.stopped = rubs >= damper * size;
  contact.sliding = !sticks;
  if (contact.sliding) contact.k.tail<2>().setConstant(contact.stopped ? damper : 0);
  contact.f.tail<2>() = -contact.k.tail<2>().cwiseProduct(follow);
  if (contact.sliding && !contact.stopped) contact.f.tail<2>() = -rubs / size * follow;
}

bool takeTouch(const PenaltyScheme& scheme, double share, double c, bool first, StiffTouch& contact,
               const std::vector<DeltaX>& moved) {
  const Vec3 follow = followOf(contact, moved);
  Vec3 k, d;
  for (int i = 0; i < 3; ++i) {
    k[i] = scheme.kappa / (share * contact.rows[i].resistance);
    d[i] = scheme.delta / (share * contact.rows[i].resistance);
  }
  contact.f[0] = -k[0] * c - d[0] * follow[0];
  if (first && !(contact.f[0] > 0)) return false;
  contact.k = k + d;
  if (scheme.implicit) {
    const double stops = -c / contact.rows[0].resistance;
    const double normal = !first ? contact.f[0] : *contact.normal > 0 ? *contact.normal : stops;
    *contact.normal = std::max(normal, 1e-300);
    rubImplicitly(std::max(normal, 0.0), follow.tail<2>(), contact);
    return true;
  }
  const Vec2 memory(contact.friction->dot(contact.rows[1].d),
                    contact.friction->dot(contact.rows[2].d));
  const Vec2 stretched = memory - k.tail<2>().cwiseProduct(follow.tail<2>());
  const Vec2 damped = -d.tail<2>().cwiseProduct(follow.tail<2>());
  rubExplicitly(stretched, damped, contact);
  return true;
}

// A contact that implicit steps have found stays for the substep, and may even pull in it: what the
// Newton steps look for must not come and go.
bool takeTouches(RivalModel& world, double dt, const PenaltyScheme& scheme, bool first,
                 StepReport& report) {
  world.penalty.touches.clear();
  report.constraintEvaluations += contactVisits(world);
  return forEachTouch(
      world, report,
      [&](const Touch& touch, double& normal, Vec3& friction, ContactPointState* point) {
        const double fastest = world.settings.contact->maxSeparationSpeed * dt;
        const double c =
            touch.gap + (scheme.implicit ? std::max(0.0, -touch.startGap - fastest) : 0.0);
        if (c >= 0 && (first || normal == 0)) {
          normal = 0;
          friction.setZero();
          return true;
        }
        const Vec3 t1 = anyNormalTo(touch.n);
        const auto& inverse = world.bodies.inverse;
        StiffTouch contact;
        contact.touch = touch;
        contact.rows = {rowOf(touch, touch.n, inverse), rowOf(touch, t1, inverse),
                        rowOf(touch, touch.n.cross(t1), inverse)};
        contact.normal = &normal;
        contact.friction = &friction;
        contact.point = point;
        if (!(contact.rows[0].resistance > 1e-300)) return true;
        const double share = scheme.implicit ? 1 : sharers(world, touch.bodies);
        if (takeTouch(scheme, share, c, first, contact, world.penalty.moved)) {
          world.penalty.touches.push_back(contact);
        } else {
          normal = 0;
        }
        return contact.f.allFinite();
      });
}

}  // namespace

PenaltyScheme schemeOf(const Settings& settings, bool implicit) {
  const double kappa = settings.penaltyStiffness.value_or(implicit ? 1e4 : 1);
  return {implicit, kappa, (implicit ? 2 : 1) * std::sqrt(kappa)};
}

// J (h v) of the three rows.
Vec3 followOf(const StiffTouch& contact, const std::vector<DeltaX>& moved) {
  Vec3 u = Vec3::Zero();
  for (int b = 0; b < contact.touch.count; ++b) {
    const DeltaX& body = moved[contact.touch.bodies[b]];
    u += contact.touch.weight[b] * (body.dx + body.dtheta.cross(contact.touch.arm[b]));
  }
  return Vec3(u.dot(contact.rows[0].d), u.dot(contact.rows[1].d), u.dot(contact.rows[2].d));
}

void takeMoved(RivalModel& world, double dt) {
  world.penalty.moved.resize(world.bodies.pose.size());
  for (int i = 0; i < world.bodies.size(); ++i) {
    world.penalty.moved[i] = {dt * world.bodies.velocity[i].v, dt * world.bodies.velocity[i].w};
  }
}

bool takeSprings(RivalModel& world, const Configuration& x, const PenaltyScheme& scheme, bool first,
                 StepReport& report) {
  report.constraintEvaluations += evaluateAll(world.kinds, x, world.frozen);
  if (!scheme.implicit) countMeetings(world, report);
  return takeRows(world, scheme, report) && takeTouches(world, x.dt, scheme, first, report);
}

}  // namespace physics
