// The hit of a pair: which points push, with what friction.
#include "physics/motion/hit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace physics {

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

namespace {

using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;

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

// What the points of a set give for what they miss, pushing only. Returns what that is wrong by
// [m/s]: a point of the set has another speed than it shall have, or one beside it is too slow.
double wrongBy(const Meeting& meeting, const Meeting::Set& set, const Vec4& missing,
               Vec4& impulses) {
  impulses = (set.inverse * missing).cwiseMax(0);
  const Vec4 left = missing - meeting.gives * impulses;
  return std::max(left.maxCoeff(), set.in.cwiseProduct(left).cwiseAbs().maxCoeff());
}

// Impulses that push only and leave no point slower than it shall be, and none faster that is
// pushed: of the sets of points that may push, the one that was right before or the one that is
// wrong by the least. A pair has one normal: whatever many points give, three can give.
Vec4 impulsesOf(Meeting& meeting, const Vec4& missing) {
  constexpr double kRight = 0.01 * kSlowest;
  Vec4 best = Vec4::Zero(), impulses;
  if (wrongBy(meeting, meeting.last, missing, best) <= kRight) return best;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned points = 1; points < 1U << meeting.pair->count && least > kRight; ++points) {
    if (std::popcount(points) > 3) continue;
    Meeting::Set set;
    for (int k = 0; k < meeting.pair->count; ++k) {
      set.in[k] = meeting.touches[k] && (points >> k & 1U);
    }
    Mat4 gives = set.in.asDiagonal() * meeting.gives * set.in.asDiagonal();
    gives.diagonal() += Vec4::Ones() - set.in;
    // By columns: to solve for a matrix is compiled for any size, with blocked products.
    const Eigen::LDLT<Mat4> factor(gives);
    for (int k = 0; k < 4; ++k) {
      set.inverse.col(k) = set.in.cwiseProduct(factor.solve(Vec4(set.in[k] * Vec4::Unit(k))));
    }
    const double wrong = wrongBy(meeting, set, missing, impulses);
    if (!(wrong < least)) continue;
    least = wrong;
    best = impulses;
    meeting.last = set;
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

  Slip(const Meeting& meeting, const Vec4& normal, const Bodies& bodies) {
    const ContactPair& pair = *meeting.pair;
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
        if (meeting.touches[k]) {
          ofFriction(k, i) = physics::gives(pair, meeting.levers[k], along[i], bodies);
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
double workOf(const Meeting& meeting, const Slip& slip, const Vec4& speed, const Hit& hit) {
  const Vec4 normals = speed + 0.5 * (meeting.gives * hit.normal + slip.ofFriction * hit.friction);
  const Vec2 sides =
      slip.speed + 0.5 * (slip.gives * hit.friction + slip.ofFriction.transpose() * hit.normal);
  return hit.normal.dot(normals) + hit.friction.dot(sides);
}

// Normals' impulses give points the speeds that they miss, and friction is Coulomb's. Where it has
// turned the slip about, what it adds on the way back may be more than restitution lost (Kane's
// paradox): then it is as much as leaves the hit without gain.
Hit hitOf(Meeting& meeting, const Vec4& speed, const Vec4& missing, const Bodies& bodies) {
  constexpr int kMostRounds = 16;  // of a uniform rod each leaves a third at most
  Hit hit;
  hit.normal = impulsesOf(meeting, missing);
  const Friction& friction = meeting.pair->friction;
  const bool isRough = meeting.pair->frictional && friction.staticCoefficient > 0;
  if (!isRough || !(hit.normal.sum() > 0)) return hit;
  const Hit smooth = hit;
  const Slip slip(meeting, hit.normal, bodies);
  hit.along = slip.along;
  for (int round = 0; round < kMostRounds; ++round) {
    const Vec2 before = hit.friction;
    hit.friction = frictionOf(friction, slip, hit.normal);
    hit.normal = impulsesOf(meeting, missing - slip.ofFriction * hit.friction);
    if ((slip.gives * (hit.friction - before)).norm() <= kSlowest) break;
  }
  // The work is a parabola of the part s of the way from without friction to with it.
  const double without = workOf(meeting, slip, speed, smooth), allowed = std::max(without, 0.0),
               with = workOf(meeting, slip, speed, hit);
  if (!(with > allowed)) return hit;
  const Hit half{0.5 * (smooth.normal + hit.normal), 0.5 * hit.friction, slip.along};
  const double bend = 2 * (with + without) - 4 * workOf(meeting, slip, speed, half),
               slope = with - without - bend, below = allowed - without;
  const double s =
      std::clamp((std::sqrt(slope * slope + 4 * bend * below) - slope) / (2 * bend), 0.0, 1.0);
  return {smooth.normal + s * (hit.normal - smooth.normal), s * hit.friction, slip.along};
}

}  // namespace

void takeLevers(Meeting& meeting, const Bodies& bodies) {
  const ContactPair& pair = *meeting.pair;
  for (int k = 0; k < pair.count; ++k) {
    if (!meeting.touches[k]) continue;
    meeting.levers[k] = leverOf(pair, k, bodies);
    for (int i = 0; i <= k; ++i) {
      if (!meeting.touches[i]) continue;
      meeting.gives(i, k) = meeting.gives(k, i) =
          gives(pair, meeting.levers[i], meeting.levers[k], bodies);
    }
  }
}

Eigen::Vector4d speedsOf(const Meeting& meeting, const Bodies& bodies) {
  Vec4 speed = Vec4::Zero();
  for (int k = 0; k < meeting.pair->count; ++k) {
    if (meeting.touches[k]) speed[k] = speedAt(*meeting.pair, meeting.levers[k], bodies);
  }
  return speed;
}

void hit(Meeting& meeting, const Vec4& speed, const Vec4& then, Bodies& bodies) {
  const ContactPair& pair = *meeting.pair;
  const Hit hit = hitOf(meeting, speed, then - speed, bodies);
  for (int i = 0; i < 2; ++i) {
    if (hit.friction[i] != 0) push(pair, hit.along[i], hit.friction[i], bodies);
  }
  for (int k = 0; k < pair.count; ++k) {
    if (hit.normal[k] > 0) push(pair, meeting.levers[k], hit.normal[k], bodies);
  }
}

}  // namespace physics
