// Restitution: impacts in turn, on velocities, and the flight after them.
#include "physics/motion/restitution.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "physics/motion/hit.h"

namespace physics {
namespace {

constexpr int kElasticSweeps = 100;  // after these, what still approaches stays together
constexpr int kMostSweeps = 200;     // as many again, to stop it

using PerPoint = std::array<double, Manifold::kMaxPoints>;

struct Impact : Meeting {
  PerPoint speed{};      // v_i of each point, 0 where it does not bounce [m/s]
  PerPoint left{};       // tau of each point [s]
  bool bounces = false;  // some point does
  bool over = false;     // it met nothing else and is done
  bool met = false;      // it is joined to an impact by bodies that touch
  bool isEarly = false;  // it was stopped on its way, and hits in a later substep
  int strikes = 0;
};

Vec3 acceleration(const Bodies& bodies, const FreeFlight& flight, BodyId body) {
  if (bodies.motion[body] != Motion::kDynamic) return Vec3::Zero();
  return flight.gravity.value_or(Vec3::Zero()) + bodies.inverse[body].m * flight.loads[body].force;
}

// v_i and tau of one point; nothing where the flight does not close the gap in this substep. One
// that only just touches at the end, without an impulse, hits then. True: the solve stopped it
// where it does not hit yet.
bool fly(const ContactPointState& p, double a, double dt, double& speed, double& left) {
  if (p.normalTotal <= 0) {  // it only just touches at the end, and hits then
    speed = std::min(p.approach, 0.0);
    return false;
  }
  const double start = p.approach - dt * a;  // before the substep's own acceleration
  const double gap = p.loaded ? 0 : std::max(p.gapAtStart, 0.0);
  const double squared = start * start - 2 * a * gap;
  if (!(squared > 0) || (start >= 0 && a >= 0)) return false;
  const double hit = -std::sqrt(squared);
  const double time = start < 0 ? -2 * gap / (start + hit) : (hit - start) / a;
  if (time > 1.5 * dt) return true;  // the prediction of (29) falls twice as far: up to sqrt(2) dt
  speed = hit;
  left = std::max(dt - time, 0.0);
  return false;
}

Vec3 accelerationApart(const ContactPair& pair, const Bodies& bodies, const FreeFlight& flight) {
  return acceleration(bodies, flight, pair.a) - acceleration(bodies, flight, pair.b);
}

// All pairs that touch at the end of the substep, those that rest too.
std::vector<Impact> impactsOf(const Contacts& contacts, const Bodies& bodies,
                              const FreeFlight& flight, double threshold) {
  std::vector<Impact> impacts;
  for (const ContactPair& pair : contacts.pairs) {
    Impact impact;
    impact.pair = &pair;
    const Vec3 apart = accelerationApart(pair, bodies, flight);
    bool touches = false;
    for (int k = 0; k < pair.count; ++k) {
      const ContactPointState& p = pair.points[k];
      impact.touches[k] = p.normalTotal > 0 || gapOf(pair, k, bodies.pose) < kClose;
      if (!impact.touches[k]) continue;
      touches = true;
      const bool isEarly = fly(p, p.normal.dot(apart), flight.dt, impact.speed[k], impact.left[k]);
      impact.isEarly = impact.isEarly || (isEarly && p.approach < -threshold);
      if (impact.speed[k] > -threshold) impact.speed[k] = 0;
      impact.bounces = impact.bounces || impact.speed[k] < 0;
    }
    if (touches) impacts.push_back(impact);
  }
  return impacts;
}

// Marks pairs that share a moving body with one that an impact reaches; tells the bodies.
std::vector<bool> spread(std::vector<Impact>& impacts, const Bodies& bodies) {
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
  return reached;
}

// What the contacts of a body gave it in the solve, times h^2.
struct Given {
  Vec3 impulse = Vec3::Zero(), turn = Vec3::Zero();
  int pairs = 0;
};

std::vector<Given> givenBy(const std::vector<Impact>& impacts, const Bodies& bodies) {
  std::vector<Given> given(bodies.pose.size());
  for (const Impact& impact : impacts) {
    const ContactPair& pair = *impact.pair;
    for (int k = 0; k < pair.count; ++k) {
      const ContactPointState& p = pair.points[k];
      const Vec3 point = pointOf(pair, k, bodies.pose);
      const Vec3 impulse = p.normalTotal * p.normal + p.frictionTotal;
      for (const double sign : {1.0, -1.0}) {
        const BodyId body = sign > 0 ? pair.a : pair.b;
        Given& sum = given[body];
        sum.pairs += k == 0;
        sum.impulse += sign * impulse;
        sum.turn += sign * (point - bodies.pose[body].x).cross(impulse);
      }
    }
  }
  return given;
}

// True where nothing but its contacts moved the body in this substep.
bool isFree(BodyId body, const FreeFlight& flight) { return !flight.attached[body]; }

// Takes back what the solve made of the contacts' impulses: exactly where only contacts moved the
// body, else to first order of its turn in the substep.
void undo(const Given& given, Bodies& bodies, BodyId body, const FreeFlight& flight) {
  if (bodies.motion[body] != Motion::kDynamic) return;
  Velocity& velocity = bodies.velocity[body];
  const InverseMass& inverse = bodies.inverse[body];
  if (isFree(body, flight)) {
    velocity = flight.before[body];
  } else {
    velocity.v -= inverse.m / flight.dt * given.impulse;
    velocity.w -= inverse.inertia * given.turn / flight.dt;
  }
}

double restitutionOf(const ContactPair& pair, const Bodies& bodies) {
  return std::max(bodies.restitution[pair.a], bodies.restitution[pair.b]);
}

// The speed that a point shall have after a hit.
double wanted(const Impact& impact, int k, double speed, double restitution, double threshold,
              double rise) {
  if (impact.strikes > 0 || impact.speed[k] == 0)
    return speed < -threshold ? -restitution * speed : 0;
  const double early = impact.speed[k] - impact.pair->points[k].approach;  // v_i against now
  return std::max(-restitution * (speed + early), 0.0) + rise;
}

// One hit of one pair. False: nothing approached.
bool strike(Impact& impact, Bodies& bodies, double restitution, double threshold, double rise) {
  const Eigen::Vector4d speed = speedsOf(impact, bodies);
  Eigen::Vector4d then = speed;
  bool approaches = false;
  for (int k = 0; k < impact.pair->count; ++k) {
    if (!impact.touches[k]) continue;
    approaches = approaches || speed[k] < -kSlowest;
    then[k] = wanted(impact, k, speed[k], restitution, threshold, rise);
  }
  if (!approaches) return false;
  hit(impact, speed, then, bodies);
  ++impact.strikes;
  return true;
}

bool meetsNothingElse(const ContactPair& pair, const std::vector<Given>& given,
                      const Bodies& bodies, const FreeFlight& flight) {
  for (const BodyId body : {pair.a, pair.b}) {
    const bool moves = bodies.motion[body] == Motion::kDynamic;
    if (moves && (given[body].pairs > 1 || !isFree(body, flight))) return false;
  }
  return true;
}

// A point of a pair that meets nothing else, whose points all hit at the same time and speed (a
// ball, a box that falls flat); -1: none.
int alone(const Impact& impact, const std::vector<Given>& given, const Bodies& bodies,
          const FreeFlight& flight) {
  const ContactPair& pair = *impact.pair;
  int any = -1;
  for (int k = 0; k < pair.count; ++k) {
    if (!impact.touches[k]) continue;
    if (any < 0) any = k;
    const double apart = std::abs(impact.speed[k] - impact.speed[any]);
    // Of equal speed, but for 1e7 roundings.
    if (impact.speed[k] == 0 || apart > -1e-9 * impact.speed[k]) return -1;
  }
  return meetsNothingElse(pair, given, bodies, flight) ? any : -1;
}

// Opens the gap by what is flown after the hit; where several points hit, without a turn.
void flyOn(const Impact& impact, int k, double gap, Bodies& bodies) {
  const ContactPair& pair = *impact.pair;
  const bool turns = std::count(impact.touches.begin(), impact.touches.end(), true) == 1;
  const double ma = bodies.inverse[pair.a].m, mb = bodies.inverse[pair.b].m;
  const Lever lever = leverOf(pair, k, bodies);
  const double part = (gap - gapOf(pair, k, bodies.pose)) / (turns ? lever.resistance : ma + mb);
  const double turn = turns ? part : 0;
  displace(bodies.pose[pair.a], ma * part * lever.n, turn * lever.wa);
  displace(bodies.pose[pair.b], -mb * part * lever.n, -turn * lever.wb);
}

// Exact in time.
bool strikeAlone(Impact& impact, int k, const std::vector<Given>& given, Bodies& bodies,
                 double threshold, const FreeFlight& flight) {
  const ContactPair& pair = *impact.pair;
  const double restitution = restitutionOf(pair, bodies);
  const double a = pair.points[k].normal.dot(accelerationApart(pair, bodies, flight));
  const double tau = impact.left[k], gap = (-restitution * impact.speed[k] + 0.5 * a * tau) * tau;
  if (!(gap > 0)) return false;
  for (const BodyId body : {pair.a, pair.b}) undo(given[body], bodies, body, flight);
  takeLevers(impact, bodies);
  strike(impact, bodies, restitution, threshold, a * tau);
  flyOn(impact, k, gap, bodies);
  return true;
}

void strikeInTurn(std::vector<Impact>& impacts, Bodies& bodies, double threshold) {
  for (Impact& impact : impacts) takeLevers(impact, bodies);
  bool struck = !impacts.empty();
  for (int sweep = 0; struck && sweep < kMostSweeps; ++sweep) {
    struck = false;
    for (Impact& impact : impacts) {
      const double e = sweep < kElasticSweeps ? restitutionOf(*impact.pair, bodies) : 0;
      struck = strike(impact, bodies, e, threshold, 0) || struck;
    }
  }
}

}  // namespace

std::vector<bool> restitute(const Contacts& contacts, Bodies& bodies, const FreeFlight& flight) {
  const double threshold =
      std::max(flight.gravity ? 2 * flight.dt * flight.gravity->norm() : 0.0, kSlowest);
  std::vector<Impact> impacts = impactsOf(contacts, bodies, flight, threshold);
  const auto matters = [](const Impact& impact) { return impact.bounces || impact.isEarly; };
  if (std::none_of(impacts.begin(), impacts.end(), matters)) return {};
  const std::vector<Given> given = givenBy(impacts, bodies);
  std::vector<bool> jumped(bodies.pose.size(), false);
  for (Impact& impact : impacts) {
    const ContactPair& pair = *impact.pair;
    if (impact.isEarly && !impact.bounces && meetsNothingElse(pair, given, bodies, flight)) {
      for (const BodyId body : {pair.a, pair.b}) undo(given[body], bodies, body, flight);
    }
    const int k = impact.bounces ? alone(impact, given, bodies, flight) : -1;
    impact.over = k >= 0 && strikeAlone(impact, k, given, bodies, threshold, flight);
    if (impact.over) jumped[impact.pair->a] = jumped[impact.pair->b] = true;
  }
  std::erase_if(impacts, [](const Impact& impact) { return impact.over; });
  const std::vector<bool> reached = spread(impacts, bodies);
  std::erase_if(impacts, [](const Impact& impact) { return !impact.met; });
  for (BodyId body = 0; body < bodies.size(); ++body) {
    if (!reached[body]) continue;
    undo(given[body], bodies, body, flight);
    jumped[body] = true;
  }
  strikeInTurn(impacts, bodies, threshold);
  return jumped;
}

}  // namespace physics
