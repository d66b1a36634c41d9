// Restitution: impacts in turn, on velocities, and the flight after them.
#include "physics/effects/restitution.h"

#include <algorithm>
#include <cmath>

#include "physics/rotation.h"

namespace physics {
namespace {

constexpr int kElasticSweeps = 100;  // after these, what still approaches stays together
constexpr int kMostSweeps = 200;
constexpr double kSlowest = 1e-9;  // m/s: slower than this is rounding

using PerPoint = std::array<double, Manifold::kMaxPoints>;

struct Impact {
  const ContactPair* pair = nullptr;
  PerPoint speed{};      // v_i of each point, 0 where it does not bounce [m/s]
  PerPoint left{};       // tau of each point [s]
  bool bounces = false;  // some point does
  bool over = false;     // it met nothing else and is done
  bool met = false;      // it is joined to an impact by bodies that touch
  int strikes = 0;
};

// What an impulse of 1 along the normal at a point does to the pair.
struct Lever {
  Vec3 n, wa, wb;  // turns: I^-1 (r x n)
  Vec3 na, nb;     // r x n
  double resistance;
};

Lever leverOf(const ContactPair& pair, int k, const Bodies& bodies) {
  Lever lever;
  lever.n = normalOf(pair, bodies.pose);
  const Vec3 point = pointOf(pair, k, bodies.pose);
  lever.na = (point - bodies.pose[pair.a].x).cross(lever.n);
  lever.nb = (point - bodies.pose[pair.b].x).cross(lever.n);
  const InverseMass &a = bodies.inverse[pair.a], &b = bodies.inverse[pair.b];
  lever.wa = a.inertia * lever.na;
  lever.wb = b.inertia * lever.nb;
  lever.resistance = a.m + b.m + lever.na.dot(lever.wa) + lever.nb.dot(lever.wb);
  return lever;
}

double speedAt(const ContactPair& pair, const Lever& lever, const Bodies& bodies) {
  const Velocity &a = bodies.velocity[pair.a], &b = bodies.velocity[pair.b];
  return lever.n.dot(a.v - b.v) + lever.na.dot(a.w) - lever.nb.dot(b.w);
}

void push(const ContactPair& pair, const Lever& lever, double impulse, Bodies& bodies) {
  Velocity &a = bodies.velocity[pair.a], &b = bodies.velocity[pair.b];
  a.v += bodies.inverse[pair.a].m * impulse * lever.n;
  b.v -= bodies.inverse[pair.b].m * impulse * lever.n;
  a.w += impulse * lever.wa;
  b.w -= impulse * lever.wb;
}

Vec3 acceleration(const Bodies& bodies, const FreeFlight& flight, BodyId body) {
  if (bodies.motion[body] != Motion::kDynamic) return Vec3::Zero();
  return flight.gravity.value_or(Vec3::Zero()) + bodies.inverse[body].m * flight.loads[body].force;
}

// v_i and tau of one point; nothing where the flight does not close the gap in this substep.
void fly(const ContactPointState& p, double a, double dt, double& speed, double& left) {
  const double start = p.approach - dt * a;  // before the substep's own acceleration
  const double gap = p.loaded ? 0 : std::max(p.gapAtStart, 0.0);
  const double squared = start * start - 2 * a * gap;
  if (!(squared > 0) || (start >= 0 && a >= 0)) return;
  const double hit = -std::sqrt(squared);
  const double time = start < 0 ? -2 * gap / (start + hit) : (hit - start) / a;
  if (time > 1.5 * dt) return;  // the prediction of (29) falls twice as far: up to sqrt(2) dt
  speed = hit;
  left = std::max(dt - time, 0.0);
}

std::vector<Impact> impactsOf(const Contacts& contacts, const Bodies& bodies,
                              const FreeFlight& flight, double threshold) {
  std::vector<Impact> impacts;
  for (const ContactPair& pair : contacts.pairs) {
    Impact impact;
    impact.pair = &pair;
    const Vec3 apart = acceleration(bodies, flight, pair.a) - acceleration(bodies, flight, pair.b);
    bool loaded = false;
    for (int k = 0; k < pair.count; ++k) {
      const ContactPointState& p = pair.points[k];
      if (p.normalTotal <= 0) continue;
      loaded = true;
      fly(p, p.normal.dot(apart), flight.dt, impact.speed[k], impact.left[k]);
      if (impact.speed[k] > -threshold) impact.speed[k] = 0;
      impact.bounces = impact.bounces || impact.speed[k] < 0;
    }
    if (loaded) impacts.push_back(impact);
  }
  return impacts;
}

// Marks what an impact can reach: pairs that share a moving body with one that was reached.
void spread(std::vector<Impact>& impacts, const Bodies& bodies) {
  std::vector<bool> reached(bodies.pose.size(), false);
  const auto moves = [&](BodyId body) { return bodies.motion[body] == Motion::kDynamic; };
  for (bool more = true; more;) {
    more = false;
    for (Impact& impact : impacts) {
      const BodyId a = impact.pair->a, b = impact.pair->b;
      const bool near = (moves(a) && reached[a]) || (moves(b) && reached[b]);
      if (impact.met || !(impact.bounces || near)) continue;
      impact.met = reached[a] = reached[b] = more = true;
    }
  }
}

// Takes back what the solve made of the normals' impulses.
void undo(const Impact& impact, Bodies& bodies, double dt) {
  for (int k = 0; k < impact.pair->count; ++k) {
    const double total = impact.pair->points[k].normalTotal;
    if (total > 0) push(*impact.pair, leverOf(*impact.pair, k, bodies), -total / dt, bodies);
  }
}

// The speed that a point shall have after a hit.
double wanted(const Impact& impact, int k, double speed, double restitution, double threshold,
              double rise) {
  if (impact.strikes > 0 || impact.speed[k] == 0)
    return speed < -threshold ? -restitution * speed : 0;
  const double early = impact.speed[k] - impact.pair->points[k].approach;  // v_i against now
  return std::max(-restitution * (speed + early), 0.0) + rise;
}

// One hit of one pair: impulses that push only, until every point has its speed. False: nothing
// approached.
bool strike(Impact& impact, Bodies& bodies, double restitution, double threshold, double rise) {
  const ContactPair& pair = *impact.pair;
  std::array<Lever, Manifold::kMaxPoints> levers;
  PerPoint target{}, total{};
  bool approaches = false;
  for (int k = 0; k < pair.count; ++k) {
    levers[k] = leverOf(pair, k, bodies);
    const double speed = speedAt(pair, levers[k], bodies);
    approaches = approaches || (pair.points[k].normalTotal > 0 && speed < -kSlowest);
    target[k] = wanted(impact, k, speed, restitution, threshold, rise);
  }
  if (!approaches) return false;
  constexpr int kSweeps = 30;  // of a manifold's four points
  for (int sweep = 0; sweep < (pair.count > 1 ? kSweeps : 1); ++sweep) {
    for (int k = 0; k < pair.count; ++k) {
      if (pair.points[k].normalTotal <= 0 || !(levers[k].resistance > 1e-300)) continue;
      const double missing = target[k] - speedAt(pair, levers[k], bodies);
      const double next = std::max(total[k] + missing / levers[k].resistance, 0.0);
      push(pair, levers[k], next - total[k], bodies);
      total[k] = next;
    }
  }
  ++impact.strikes;
  return true;
}

// True where nothing but this contact moved the body in this substep.
bool isAlone(const ContactPair& pair, int k, BodyId body, const Bodies& bodies) {
  if (bodies.motion[body] != Motion::kDynamic) return true;
  const ContactPointState& p = pair.points[k];
  const double sign = body == pair.a ? 1 : -1;
  const Vec3 own = sign * bodies.inverse[body].m * (p.normalTotal * p.normal + p.frictionTotal);
  const Correction& correction = bodies.correction[body];
  return (bodies.shift[body] - own).norm() <= 1e-9 * own.norm() && correction.dx.isZero(0) &&
         correction.dtheta.isZero(0);
}

// The only point of a pair that carries an impulse and meets nothing else; -1: none.
int alone(const Impact& impact, const Bodies& bodies) {
  int only = -1, count = 0;
  for (int k = 0; k < impact.pair->count; ++k) {
    if (impact.pair->points[k].normalTotal > 0) only = k, ++count;
  }
  if (count != 1 || impact.speed[only] == 0) return -1;
  const bool free = isAlone(*impact.pair, only, impact.pair->a, bodies) &&
                    isAlone(*impact.pair, only, impact.pair->b, bodies);
  return free ? only : -1;
}

// Opens the gap by what is flown after the hit.
void flyOn(const ContactPair& pair, int k, double gap, Bodies& bodies) {
  const Lever lever = leverOf(pair, k, bodies);
  const double part = (gap - gapOf(pair, k, bodies.pose)) / lever.resistance;
  displace(bodies.pose[pair.a], bodies.inverse[pair.a].m * part * lever.n, part * lever.wa);
  displace(bodies.pose[pair.b], -bodies.inverse[pair.b].m * part * lever.n, -part * lever.wb);
}

// A hit that nothing else meets: exact in time.
bool strikeAlone(Impact& impact, Bodies& bodies, double restitution, double threshold,
                 const FreeFlight& flight) {
  const int k = alone(impact, bodies);
  if (k < 0) return false;
  const ContactPair& pair = *impact.pair;
  const double a = pair.points[k].normal.dot(acceleration(bodies, flight, pair.a) -
                                             acceleration(bodies, flight, pair.b));
  const double tau = impact.left[k], gap = (-restitution * impact.speed[k] + 0.5 * a * tau) * tau;
  if (!(gap > 0)) return false;
  undo(impact, bodies, flight.dt);
  strike(impact, bodies, restitution, threshold, a * tau);
  flyOn(pair, k, gap, bodies);
  return true;
}

}  // namespace

void restitute(const Contacts& contacts, Bodies& bodies, double restitution,
               const FreeFlight& flight) {
  const double threshold =
      std::max(flight.gravity ? 2 * flight.dt * flight.gravity->norm() : 0.0, kSlowest);
  std::vector<Impact> impacts = impactsOf(contacts, bodies, flight, threshold);
  for (Impact& impact : impacts) {
    impact.over = impact.bounces && strikeAlone(impact, bodies, restitution, threshold, flight);
  }
  std::erase_if(impacts, [](const Impact& impact) { return impact.over; });
  spread(impacts, bodies);
  std::erase_if(impacts, [](const Impact& impact) { return !impact.met; });
  for (const Impact& impact : impacts) undo(impact, bodies, flight.dt);
  bool struck = !impacts.empty();
  for (int sweep = 0; struck && sweep < kMostSweeps; ++sweep) {
    struck = false;
    const double e = sweep < kElasticSweeps ? restitution : 0;
    for (Impact& impact : impacts) struck = strike(impact, bodies, e, threshold, 0) || struck;
  }
}

}  // namespace physics
