// Contact: the solve of one manifold.
#include <cmath>

#include "physics/constraints/contact.h"
#include "physics/rotation.h"

namespace physics {
namespace {

// What one visit to a pair works on. Impulses on b are the opposite of those on a, at the same point.
struct Visit {
  Vec3 n, t1, t2;
  Mat3 rotationA, rotationB;
  double inverseMass;                                     // 1/m_a + 1/m_b
  Vec3 impulse = Vec3::Zero();                            // sum on a, times h^2
  Vec3 turnA = Vec3::Zero(), turnB = Vec3::Zero();        // rotations so far in this visit
  std::array<Vec3, Manifold::kMaxPoints> armA, armB;      // p_a from either centre
  std::array<double, Manifold::kMaxPoints> gap;
};

Visit beginVisit(const ContactPair& pair, const Bodies& bodies) {
  Visit visit;
  const Pose &a = bodies.pose[pair.a], &b = bodies.pose[pair.b];
  visit.rotationA = a.q.toRotationMatrix();
  visit.rotationB = b.q.toRotationMatrix();
  visit.n = normalOf(pair, bodies.pose);
  visit.inverseMass = bodies.inverse[pair.a].m + bodies.inverse[pair.b].m;
  return visit;
}

// c of (91) at the present poses; true when some row has work to do.
bool evaluateGaps(const ContactPair& pair, const Bodies& bodies, double allowance, Visit& visit) {
  const Vec3 between = bodies.pose[pair.a].x - bodies.pose[pair.b].x;
  bool active = false;
  for (int k = 0; k < pair.count; ++k) {
    const ContactPointState& p = pair.points[k];
    visit.armA[k] = visit.rotationA * p.shape.coreA - p.shape.radiusA * visit.n;
    visit.armB[k] = visit.armA[k] + between;
    const Vec3 matter = visit.rotationB * (pair.radial ? p.shape.coreB : p.anchorB);
    const double offset = pair.radial ? -p.shape.radiusB : p.gapAtStart;
    double c = (visit.armB[k] - matter).dot(visit.n) + offset;
    const double overlap = -p.gapAtStart;  // of this, at most `allowance` is resolved now; NOTES 3.3
    if (overlap > allowance) c += overlap - allowance;
    visit.gap[k] = c;
    active = active || c < 0 || p.normalTotal > 0;
  }
  return active;
}

// Velocity-free form of a row's motion: J dX along d at point k, for what this visit has done so far.
double moved(const Visit& visit, const Vec3& d, const Vec3& armCrossA, const Vec3& armCrossB) {
  return visit.inverseMass * visit.impulse.dot(d) + armCrossA.dot(visit.turnA) -
         armCrossB.dot(visit.turnB);
}

void solveNormal(ContactPointState& p, int k, const Bodies& bodies, BodyId a, BodyId b, double xi,
                 Visit& visit) {
  const Vec3 na = visit.armA[k].cross(visit.n), nb = visit.armB[k].cross(visit.n);
  const Vec3 wa = bodies.inverse[a].inertia * na, wb = bodies.inverse[b].inertia * nb;
  const double resistance = visit.inverseMass + na.dot(wa) + nb.dot(wb);  // 1/mu (93)
  if (!(resistance > 1e-300)) return;
  const double c = visit.gap[k] + moved(visit, visit.n, na, nb);
  const double next = std::max(p.normalTotal - xi * c / resistance, 0.0);  // (95) on the total
  const double change = next - p.normalTotal;
  p.normalTotal = next;
  visit.impulse += change * visit.n;
  visit.turnA += change * wa;
  visit.turnB -= change * wb;
}

// (101): within nu_s N it sticks, beyond it slides with nu_d N.
bool clampFriction(Vec2& total, const Friction& friction, double normal) {
  const double squared = total.squaredNorm(), limit = friction.staticCoefficient * normal;
  if (squared <= limit * limit) return true;
  total *= friction.dynamicCoefficient * normal / std::sqrt(squared);
  return false;
}

void solveFriction(const ContactPair& pair, ContactPointState& p, int k, const Bodies& bodies,
                   double xi, Visit& visit) {
  const Vec3 &ra = visit.armA[k], &rb = visit.armB[k];
  const Mat3 &ia = bodies.inverse[pair.a].inertia, &ib = bodies.inverse[pair.b].inertia;
  const Vec3 a1 = ra.cross(visit.t1), a2 = ra.cross(visit.t2);
  const Vec3 b1 = rb.cross(visit.t1), b2 = rb.cross(visit.t2);
  const Vec3 wa1 = ia * a1, wa2 = ia * a2, wb1 = ib * b1, wb2 = ib * b2;
  const double k11 = visit.inverseMass + a1.dot(wa1) + b1.dot(wb1);
  const double k22 = visit.inverseMass + a2.dot(wa2) + b2.dot(wb2);
  const double k12 = a1.dot(wa2) + b1.dot(wb2);
  const double determinant = k11 * k22 - k12 * k12;
  if (!(determinant > 1e-300)) return;
  const Vec3 onA = p.shape.radiusA == 0 ? ra : Vec3(visit.rotationA * p.anchorA);
  const Vec3 dp = p.slip + (rb - ra) + onA - visit.rotationB * p.anchorB;
  const double c1 = dp.dot(visit.t1) + moved(visit, visit.t1, a1, b1);
  const double c2 = dp.dot(visit.t2) + moved(visit, visit.t2, a2, b2);
  const Vec2 before(p.frictionTotal.dot(visit.t1), p.frictionTotal.dot(visit.t2));
  Vec2 total = before - xi / determinant * Vec2(k22 * c1 - k12 * c2, k11 * c2 - k12 * c1);  // (100)
  p.sticking = clampFriction(total, pair.friction, p.normalTotal);
  const Vec2 change = total - before;
  p.frictionTotal = total.x() * visit.t1 + total.y() * visit.t2;
  visit.impulse += change.x() * visit.t1 + change.y() * visit.t2;
  visit.turnA += change.x() * wa1 + change.y() * wa2;
  visit.turnB -= change.x() * wb1 + change.y() * wb2;
}

void displacePair(const ContactPair& pair, const Vec3& impulse, const Vec3& turnA,
                  const Vec3& turnB, Bodies& bodies) {
  const Vec3 dxA = bodies.inverse[pair.a].m * impulse, dxB = -bodies.inverse[pair.b].m * impulse;
  displace(bodies.pose[pair.a], dxA, turnA);
  displace(bodies.pose[pair.b], dxB, turnB);
  bodies.shift[pair.a] += dxA;
  bodies.shift[pair.b] += dxB;
}

// What a sticking point is off by at the end of the last substep, by its anchors of then.
Vec3 slipLeft(const ContactPointState& p, const Vec3& n, const Pose& a, const Pose& b) {
  if (!p.sticking || p.normalTotal == 0) return Vec3::Zero();
  const Vec3 dp = p.slip + (a.x + a.q * p.anchorA) - (b.x + b.q * p.anchorB);
  return dp - dp.dot(n) * n;
}

}  // namespace

void measureStart(ContactPair& pair, const Bodies& bodies) {
  const Pose &a = bodies.start[pair.a], &b = bodies.start[pair.b];
  const Vec3 n = normalOf(pair, bodies.start);
  const Mat3 rotationA = a.q.toRotationMatrix(), rotationB = b.q.toRotationMatrix();
  const Velocity &va = bodies.velocity[pair.a], &vb = bodies.velocity[pair.b];
  for (int k = 0; k < pair.count; ++k) {
    ContactPointState& p = pair.points[k];
    const Vec3 armA = rotationA * p.shape.coreA - p.shape.radiusA * n;
    const Vec3 armB = armA + a.x - b.x;
    p.anchorA = p.shape.radiusA == 0 ? p.shape.coreA : Vec3(rotationA.transpose() * armA);
    p.anchorB = rotationB.transpose() * armB;
    p.gapAtStart = (armB - rotationB * p.shape.coreB).dot(n) - p.shape.radiusB;
    p.approach = n.dot(va.v + va.w.cross(armA) - vb.v - vb.w.cross(armB));
  }
}

void prepare(ContactPair& pair, Bodies& bodies, bool warm) {
  const Pose &a = bodies.start[pair.a], &b = bodies.start[pair.b];
  const Vec3 n = normalOf(pair, bodies.start);
  for (int k = 0; k < pair.count; ++k) pair.points[k].slip = slipLeft(pair.points[k], n, a, b);
  measureStart(pair, bodies);
  Vec3 impulse = Vec3::Zero(), torqueA = Vec3::Zero(), torqueB = Vec3::Zero();
  for (int k = 0; k < pair.count; ++k) {
    ContactPointState& p = pair.points[k];
    // The smaller of the last two: an impact is over after one substep and must not be guessed again.
    const double first = warm ? std::min(p.normalTotal, p.normalBefore) : 0;
    const double share = p.normalTotal > 0 ? first / p.normalTotal : 0;
    p.normalBefore = p.normalTotal;
    p.normalTotal = first;
    p.frictionTotal = share * (p.frictionTotal - p.frictionTotal.dot(n) * n);
    const Vec3 onA = p.normalTotal * n + p.frictionTotal;
    const Vec3 armA = a.q * p.anchorA;
    impulse += onA;
    torqueA += armA.cross(onA);
    torqueB += (armA + a.x - b.x).cross(onA);
  }
  if (impulse.isZero(0)) return;
  displacePair(pair, impulse, bodies.inverse[pair.a].inertia * torqueA,
               -bodies.inverse[pair.b].inertia * torqueB, bodies);
}

bool solve(ContactPair& pair, Bodies& bodies, double xi, double allowance) {
  Visit visit = beginVisit(pair, bodies);
  if (!evaluateGaps(pair, bodies, allowance, visit)) return true;
  for (int k = 0; k < pair.count; ++k) {
    solveNormal(pair.points[k], k, bodies, pair.a, pair.b, xi, visit);
  }
  if (pair.friction.staticCoefficient > 0) {
    visit.t1 = anyNormalTo(visit.n);
    visit.t2 = visit.n.cross(visit.t1);
    for (int k = 0; k < pair.count; ++k) {
      ContactPointState& p = pair.points[k];
      if (p.normalTotal > 0 || !p.frictionTotal.isZero(0)) {
        solveFriction(pair, p, k, bodies, xi, visit);
      }
    }
  }
  if (!(visit.impulse.allFinite() && visit.turnA.allFinite() && visit.turnB.allFinite())) {
    return false;
  }
  displacePair(pair, visit.impulse, visit.turnA, visit.turnB, bodies);
  return true;
}

}  // namespace physics
