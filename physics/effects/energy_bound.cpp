// The bound on the energy of bodies in contact.
#include "physics/effects/energy_bound.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "physics/constraints/constraint_response.h"
#include "physics/effects/choose_scheme.h"
#include "physics/model/islands.h"
#include "physics/motion/second_order.h"
#include "physics/state/world_state.h"
#include "physics/sweep/nonlinear_gauss_seidel.h"

namespace physics {
namespace {

constexpr double kRounding = 1e-9;  // of the kinetic energy: no gain
// Of m (g h)^2: no gain where nothing is joined. Bodies that settle on each other gain and lose by
// what their sweeps leave; without it a tower of one sweep topples.
constexpr double kSettling = 50;

// One island: what it weighs, how it moves, and what it may have of energy.
struct Whole {
  bool jointed = false, pushed = false, driven = false, bounded = false;
  double mass = 0, kinetic = 0, allowed = 0;
  Vec3 centre = Vec3::Zero(), momentum = Vec3::Zero(), spin = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();  // the rigid part, at the centre
  double inner = 1, outer = 1;              // factors of the relative and of the rigid part
};

bool applies(const WorldState& w) {
  return w.touches && !isSecondOrder(w.settings) && w.settings.stepping != Stepping::kStatic;
}

double kineticEnergy(const Bodies& b, BodyId i) {
  if (b.motion[i] != Motion::kDynamic) return 0;
  const Velocity& velocity = b.velocity[i];
  return 0.5 * b.mass[i] * velocity.v.squaredNorm() +
         0.5 * velocity.w.dot(angularMomentum(b, i, velocity.w));
}

// Its kinetic energy at the start, and what gravity and loads did [J].
double allowedOf(const WorldState& w, BodyId i, double h) {
  const Velocity& velocity = w.bodies.velocity[i];
  const Vec3 force =
      w.bodies.mass[i] * w.settings.gravity.value_or(Vec3::Zero()) + w.loads[i].force;
  return w.kineticBefore[i] + h * (force.dot(velocity.v) + w.loads[i].torque.dot(velocity.w));
}

// What a mass may gain where nothing is joined [J].
double settling(const WorldState& w, double mass, double h) {
  const Vec3 g = w.settings.gravity.value_or(Vec3::Zero());
  return kSettling * mass * h * h * g.squaredNorm();
}

// Whether some island can have: one that gains too much has a body that does.
bool mayGain(const WorldState& w, double h) {
  const std::vector<ContactPair>& pairs = w.contacts.pairs;
  const bool pushes = !w.contacts.lost.empty() ||
                      std::any_of(pairs.begin(), pairs.end(),
                                  [](const ContactPair& pair) { return !pair.given.isZero(0); });
  const std::vector<BodyId>& active = w.bodies.active;
  const auto gains = [&](BodyId i) {
    return kineticEnergy(w.bodies, i) - allowedOf(w, i, h) > settling(w, w.bodies.mass[i], h);
  };
  return pushes && (!onlyContacts(w) || std::any_of(active.begin(), active.end(), gains));
}

// What joints and this substep's contacts join.
Islands islandsNow(WorldState& w) {
  Islands islands = jointIslands(w);
  joinPushed(w.contacts, w.bodies, islands);
  settle(islands, w.bodies.active);
  return islands;
}

// What a force or a motor does in the substep: its impulse times the rate that it ends with [J].
template <class C>
double workOf(const C& item, const Multipliers<C>& lambda, const Bodies& bodies, double h,
              Scratch<C>& s) {
  item.evaluate({bodies.pose, bodies.start, h}, s.row);
  if (!s.row.active) return 0;
  typename Set<C>::Vector rate = Set<C>::Vector::Zero();
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const Velocity& velocity = bodies.velocity[item.bodies[b]];
    if constexpr (C::kLinear) rate += s.row.linear[b] * velocity.v;
    if constexpr (isAngular<C>()) rate += s.row.angular[b] * velocity.w;
  }
  return lambda.total.dot(rate) / h;
}

// What contacts move, and what joins it and does work on it. What moved bodies do is not known:
// their islands are left alone.
void mark(WorldState& w, const Islands& islands, double h, std::vector<Whole>& wholes) {
  forEachPush(w.contacts, [&](const ContactPair& pair) {
    for (const BodyId body : {pair.a, pair.b}) {
      wholes[islands[body]].pushed = true;
      if (w.bodies.motion[body] != Motion::kKinematic) continue;
      wholes[islands[pair.a]].driven = wholes[islands[pair.b]].driven = true;
    }
  });
  for (const BodyId i : w.bodies.active) {
    if (w.bodies.motion[i] == Motion::kKinematic) wholes[islands[i]].driven = true;
  }
  forEachKind(w.kinds, [&](auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    for (const int k : kind.set.active) {
      const C& item = kind.set.items[k];
      Whole& whole = wholes[islands[moverOf(item, w.bodies)]];
      whole.jointed = true;
      if (canStand<C>() || !whole.pushed) continue;
      whole.allowed += workOf(item, kind.set.lambda[k], w.bodies, h, kind.set.scratch);
    }
  });
}

void sumUp(const WorldState& w, const Islands& islands, double h, std::vector<Whole>& wholes) {
  const Bodies& b = w.bodies;
  for (const BodyId i : b.active) {
    Whole& whole = wholes[islands[i]];
    whole.mass += b.mass[i];
    whole.centre += b.mass[i] * b.pose[i].x;
    whole.momentum += b.mass[i] * b.velocity[i].v;
    whole.kinetic += kineticEnergy(b, i);
    whole.allowed += allowedOf(w, i, h);
  }
}

bool gains(const WorldState& w, const Whole& whole, double h) {
  if (!whole.pushed || whole.driven) return false;
  const double least = kRounding * whole.kinetic + (whole.jointed ? 0 : settling(w, whole.mass, h));
  return whole.kinetic - whole.allowed > least;
}

// The rigid motion of the same momenta; none about an axis that nothing is away from.
void findRigidPart(const WorldState& w, const Islands& islands, BodyId root, Whole& whole) {
  const Bodies& b = w.bodies;
  whole.centre /= whole.mass;
  whole.v = whole.momentum / whole.mass;
  for (const BodyId i : b.active) {
    if (islands[i] != root) continue;
    const Vec3 arm = b.pose[i].x - whole.centre;
    const Mat3 rotation = b.pose[i].q.toRotationMatrix();
    whole.inertia += b.mass[i] * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose()) +
                     rotation * b.inertia[i].asDiagonal() * rotation.transpose();
    whole.spin += b.mass[i] * arm.cross(b.velocity[i].v) + angularMomentum(b, i, b.velocity[i].w);
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(whole.inertia);
  const double least = 1e-12 * axes.eigenvalues()[2];
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = axes.eigenvectors().col(k);
    if (axes.eigenvalues()[k] > least) {
      whole.w += axis.dot(whole.spin) / axes.eigenvalues()[k] * axis;
    }
  }
}

// s of K_rigid + s^2 (K - K_rigid) = allowed, else the rigid part alone as far as is allowed.
void findFactors(Whole& whole) {
  const double rigid =
      0.5 * whole.mass * whole.v.squaredNorm() + 0.5 * whole.w.dot(whole.inertia * whole.w);
  const double room = whole.allowed - rigid;
  if (room >= 0) {
    whole.inner = std::sqrt(room / (whole.kinetic - rigid));
  } else {
    whole.inner = 0;
    whole.outer = std::sqrt(std::max(whole.allowed, 0.0) / rigid);
  }
}

void scale(Bodies& b, BodyId i, const Whole& whole) {
  const Vec3 v = whole.v + whole.w.cross(b.pose[i].x - whole.centre);
  Velocity& velocity = b.velocity[i];
  velocity.v = whole.outer * v + whole.inner * (velocity.v - v);
  if (b.inverseInertia[i].isZero(0)) return;
  velocity.w = whole.outer * whole.w + whole.inner * (velocity.w - whole.w);
}

}  // namespace

void noteKineticEnergy(WorldState& w) {
  w.kineticBefore.clear();
  if (!applies(w)) return;
  w.kineticBefore.resize(w.bodies.pose.size());
  for (const BodyId i : w.bodies.active) w.kineticBefore[i] = kineticEnergy(w.bodies, i);
}

int boundEnergy(WorldState& w, double h) {
  if (w.kineticBefore.empty() || !mayGain(w, h)) return 0;
  const Islands islands = islandsNow(w);
  std::vector<Whole> wholes(islands.size());
  mark(w, islands, h, wholes);
  sumUp(w, islands, h, wholes);
  int bounded = 0;
  for (const BodyId i : w.bodies.active) {
    if (islands[i] != i || !gains(w, wholes[i], h)) continue;
    wholes[i].bounded = true;
    findRigidPart(w, islands, i, wholes[i]);
    findFactors(wholes[i]);
    ++bounded;
  }
  if (bounded == 0) return 0;
  for (const BodyId i : w.bodies.active) {
    if (wholes[islands[i]].bounded) scale(w.bodies, i, wholes[islands[i]]);
  }
  return bounded;
}

}  // namespace physics
