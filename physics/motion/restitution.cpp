// Restitution: impacts in turn, on velocities, and the flight after them.
#include "physics/motion/restitution.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "physics/base/rotation.h"

namespace physics {
namespace {

constexpr int kElasticSweeps = 100;  // after these, what still approaches stays together
constexpr int kMostSweeps = 200;     // as many again, to stop it
constexpr double kSlowest = 1e-9;    // m/s: slower than this is rounding

using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;
using PerPoint = std::array<double, Manifold::kMaxPoints>;

// What an impulse of 1 along a direction at a point does to the pair.
struct Lever {
  Vec3 n, wa, wb;  // turns: I^-1 (r x n)
  Vec3 na, nb;     // r x n
  double resistance;
};

struct Impact {
  const ContactPair* pair = nullptr;
  std::array<Lever, Manifold::kMaxPoints> levers{};  // of the points that touch
  Mat4 gives = Mat4::Zero();  // the speed at point i of an impulse of 1 at j [1/kg]
  struct Set {  // of points: 1 for those that are in, and what `gives` is inverse to there
    Vec4 in = Vec4::Zero();
    Mat4 inverse = Mat4::Zero();
  };
  Set last;  // that pushed
  std::array<bool, Manifold::kMaxPoints> touches{};
  PerPoint speed{};      // v_i of each point, 0 where it does not bounce [m/s]
  PerPoint left{};       // tau of each point [s]
  bool bounces = false;  // some point does
  bool over = false;     // it met nothing else and is done
  bool met = false;      // it is joined to an impact by bodies that touch
  bool isEarly = false;  // it was stopped on its way, and hits in a later substep
  int strikes = 0;
};

Lever leverOf(const ContactPair& pair, const Vec3& point, const Vec3& n, const Bodies& bodies) {
  Lever lever;
  lever.n = n;
  lever.na = (point - bodies.pose[pair.a].x).cross(lever.n);
  lever.nb = (point - bodies.pose[pair.b].x).cross(lever.n);
  const InverseMass &a = bodies.inverse[pair.a], &b = bodies.inverse[pair.b];
  lever.wa = a.inertia * lever.na;
  lever.wb = b.inertia * lever.nb;
  lever.resistance = a.m + b.m + lever.na.dot(lever.wa) + lever.nb.dot(lever.wb);
  return lever;
}

Lever leverOf(const ContactPair& pair, int k, const Bodies& bodies) {
  return leverOf(pair, pointOf(pair, k, bodies.pose), normalOf(pair, bodies.pose), bodies);
}

// The speed along p of an impulse of 1 along q [1/kg].
double gives(const ContactPair& pair, const Lever& p, const Lever& q, const Bodies& bodies) {
  const double m = bodies.inverse[pair.a].m + bodies.inverse[pair.b].m;
  return m * p.n.dot(q.n) + p.na.dot(q.wa) + p.nb.dot(q.wb);
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

// For as long as the poses stand.
void lever(Impact& impact, const Bodies& bodies) {
  const ContactPair& pair = *impact.pair;
  for (int k = 0; k < pair.count; ++k) {
    if (!impact.touches[k]) continue;
    impact.levers[k] = leverOf(pair, k, bodies);
    for (int i = 0; i <= k; ++i) {
      if (!impact.touches[i]) continue;
      impact.gives(i, k) = impact.gives(k, i) =
          gives(pair, impact.levers[i], impact.levers[k], bodies);
    }
  }
}

// What the points of a set give is none of what others miss, and all of what their own do: what it
// is wrong by [m/s]. They push only.
double wrongBy(const Impact& impact, const Impact::Set& set, const Vec4& missing, Vec4& impulses) {
  impulses = (set.inverse * missing).cwiseMax(0);
  const Vec4 left = missing - impact.gives * impulses;
  return std::max(left.maxCoeff(), set.in.cwiseProduct(left).cwiseAbs().maxCoeff());
}

// Impulses that push only and leave no point slower than it shall be, and none faster that is
// pushed: of the sets of points that may push, the one that was right before or the one that is
// wrong by the least. A pair has one normal: whatever many points give, three can give.
Vec4 impulsesOf(Impact& impact, const Vec4& missing) {
  constexpr double kRight = 0.01 * kSlowest;
  Vec4 best = Vec4::Zero(), impulses;
  if (wrongBy(impact, impact.last, missing, best) <= kRight) return best;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned points = 1; points < 1U << impact.pair->count && least > kRight; ++points) {
    if (std::popcount(points) > 3) continue;
    Impact::Set set;
    for (int k = 0; k < impact.pair->count; ++k) {
      set.in[k] = impact.touches[k] && (points >> k & 1U);
    }
    Mat4 gives = set.in.asDiagonal() * impact.gives * set.in.asDiagonal();
    gives.diagonal() += Vec4::Ones() - set.in;
    set.inverse = set.in.asDiagonal() * gives.ldlt().solve(Mat4(set.in.asDiagonal()));
    const double wrong = wrongBy(impact, set, missing, impulses);
    if (!(wrong < least)) continue;
    least = wrong;
    best = impulses;
    impact.last = set;
  }
  return best;
}

// The impulses of one hit: along the normal at each point, and of friction where these act.
struct Hit {
  Vec4 normal = Vec4::Zero();
  Vec2 friction = Vec2::Zero();
  std::array<Lever, 2> along{};  // what friction acts along
};

// How friction, along two directions where the normals act, and these give speed to each other.
struct Slip {
  std::array<Lever, 2> along;
  Vec2 speed = Vec2::Zero();
  Eigen::Matrix2d gives, inverse;
  Eigen::Matrix<double, 4, 2> ofFriction;  // the speed along normals of an impulse of friction

  Slip(const Impact& impact, const Vec4& normal, const Bodies& bodies) {
    const ContactPair& pair = *impact.pair;
    const Vec3 n = normalOf(pair, bodies.pose), side = n.unitOrthogonal();
    Vec3 at = Vec3::Zero();
    for (int k = 0; k < pair.count; ++k) at += normal[k] * pointOf(pair, k, bodies.pose);
    at /= normal.sum();
    along = {leverOf(pair, at, side, bodies), leverOf(pair, at, n.cross(side), bodies)};
    ofFriction.setZero();
    for (int i = 0; i < 2; ++i) {
      speed[i] = speedAt(pair, along[i], bodies);
      for (int j = 0; j < 2; ++j) gives(i, j) = physics::gives(pair, along[i], along[j], bodies);
      for (int k = 0; k < pair.count; ++k) {
        if (impact.touches[k]) {
          ofFriction(k, i) = physics::gives(pair, impact.levers[k], along[i], bodies);
        }
      }
    }
    inverse = gives.inverse();
  }
};

// It ends the slip, or is as much as Coulomb's law has of all that presses.
Vec2 frictionOf(const Friction& friction, const Slip& slip, const Vec4& normal) {
  const Vec2 sticks = -slip.inverse * (slip.speed + slip.ofFriction.transpose() * normal);
  const double size = sticks.norm(), pressed = normal.sum();
  if (size <= friction.staticCoefficient * pressed) return sticks;
  return friction.dynamicCoefficient * pressed / size * sticks;
}

// What `hit` adds to the kinetic energy of a pair that meets at `speed` along its normals [J].
double workOf(const Impact& impact, const Slip& slip, const Vec4& speed, const Hit& hit) {
  const Vec4 normals = speed + 0.5 * (impact.gives * hit.normal + slip.ofFriction * hit.friction);
  const Vec2 sides =
      slip.speed + 0.5 * (slip.gives * hit.friction + slip.ofFriction.transpose() * hit.normal);
  return hit.normal.dot(normals) + hit.friction.dot(sides);
}

// Normals' impulses give points the speeds that they miss, and friction is Coulomb's. Where it has
// turned the slip about, what it adds on the way back may be more than restitution lost (Kane's
// paradox): then it is as much as leaves the hit without gain.
Hit hitOf(Impact& impact, const Vec4& speed, const Vec4& missing, const Bodies& bodies) {
  constexpr int kMostRounds = 16;  // of a uniform rod each leaves a third at most
  Hit hit;
  hit.normal = impulsesOf(impact, missing);
  const Friction& friction = impact.pair->friction;
  const bool isRough = impact.pair->frictional && friction.staticCoefficient > 0;
  if (!isRough || !(hit.normal.sum() > 0)) return hit;
  const Hit smooth = hit;
  const Slip slip(impact, hit.normal, bodies);
  hit.along = slip.along;
  for (int round = 0; round < kMostRounds; ++round) {
    const Vec2 before = hit.friction;
    hit.friction = frictionOf(friction, slip, hit.normal);
    hit.normal = impulsesOf(impact, missing - slip.ofFriction * hit.friction);
    if ((slip.gives * (hit.friction - before)).norm() <= kSlowest) break;
  }
  // The work is a parabola of the part s of the way from without friction to with it.
  const double without = workOf(impact, slip, speed, smooth), allowed = std::max(without, 0.0),
               with = workOf(impact, slip, speed, hit);
  if (!(with > allowed)) return hit;
  const Hit half{0.5 * (smooth.normal + hit.normal), 0.5 * hit.friction, slip.along};
  const double bend = 2 * (with + without) - 4 * workOf(impact, slip, speed, half),
               slope = with - without - bend, below = allowed - without;
  const double s =
      std::clamp((std::sqrt(slope * slope + 4 * bend * below) - slope) / (2 * bend), 0.0, 1.0);
  return {smooth.normal + s * (hit.normal - smooth.normal), s * hit.friction, slip.along};
}

// One hit of one pair. False: nothing approached.
bool strike(Impact& impact, Bodies& bodies, double restitution, double threshold, double rise) {
  const ContactPair& pair = *impact.pair;
  Vec4 speed = Vec4::Zero(), missing = Vec4::Zero();  // [m/s]
  bool approaches = false;
  for (int k = 0; k < pair.count; ++k) {
    if (!impact.touches[k]) continue;
    speed[k] = speedAt(pair, impact.levers[k], bodies);
    approaches = approaches || speed[k] < -kSlowest;
    missing[k] = wanted(impact, k, speed[k], restitution, threshold, rise) - speed[k];
  }
  if (!approaches) return false;
  const Hit hit = hitOf(impact, speed, missing, bodies);
  for (int i = 0; i < 2; ++i)
    if (hit.friction[i] != 0) push(pair, hit.along[i], hit.friction[i], bodies);
  for (int k = 0; k < pair.count; ++k)
    if (hit.normal[k] > 0) push(pair, impact.levers[k], hit.normal[k], bodies);
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
  lever(impact, bodies);
  strike(impact, bodies, restitution, threshold, a * tau);
  flyOn(impact, k, gap, bodies);
  return true;
}

void strikeInTurn(std::vector<Impact>& impacts, Bodies& bodies, double threshold) {
  for (Impact& impact : impacts) lever(impact, bodies);
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
