// Contact: the solve of one manifold.
#include <algorithm>
#include <cmath>

#include "physics/constraints/contact.h"
#include "physics/rotation.h"

namespace physics {
namespace {

// Impulses, times h^2, on a at points of contact, and the turn they give a; b gets the opposite: it
// moves by -impulse/m_b and turns by -turnB.
struct Push {
  Vec3 impulse = Vec3::Zero();
  Vec3 turnA = Vec3::Zero(), turnB = Vec3::Zero();
};

// What one visit to a pair works on.
struct Visit {
  Vec3 n, t1, t2;
  Mat3 rotationA, rotationB;
  double inverseMass;  // 1/m_a + 1/m_b
  Push lasting, once;  // of this visit: of the motion, and of what stood wrong at the start
  Vec3 correctionX, correctionA, correctionB;  // corrections before this visit, b against a; turns
  bool corrects = false;                       // something stood wrong here, or nearby
  std::array<Vec3, Manifold::kMaxPoints> armA, armB;  // p_a from either centre
  std::array<double, Manifold::kMaxPoints> gap;
};

constexpr double kNoError = 1e-10;  // m; overlaps below this are rounding

Visit beginVisit(const ContactPair& pair, const Bodies& bodies) {
  Visit visit;
  visit.rotationA = bodies.pose[pair.a].q.toRotationMatrix();
  visit.rotationB = bodies.pose[pair.b].q.toRotationMatrix();
  visit.n = pair.carried ? Vec3(visit.rotationB * pair.normal) : normalOf(pair, bodies.pose);
  visit.inverseMass = bodies.inverse[pair.a].m + bodies.inverse[pair.b].m;
  const Correction &a = bodies.correction[pair.a], &b = bodies.correction[pair.b];
  visit.correctionX = a.dx - b.dx;
  visit.correctionA = a.dtheta;
  visit.correctionB = b.dtheta;
  visit.corrects = !(visit.correctionX.isZero(0) && a.dtheta.isZero(0) && b.dtheta.isZero(0));
  return visit;
}

// c of (91) at the present poses; true when some row has work to do.
bool evaluateGaps(const ContactPair& pair, const Bodies& bodies, Visit& visit) {
  const Vec3 between = bodies.pose[pair.a].x - bodies.pose[pair.b].x;
  bool active = false;
  for (int k = 0; k < pair.count; ++k) {
    const ContactPointState& p = pair.points[k];
    visit.armA[k] = visit.rotationA * p.shape.coreA - p.shape.radiusA * visit.n;
    visit.armB[k] = visit.armA[k] + between;
    const Vec3 matter = visit.rotationB * (pair.radial ? p.shape.coreB : p.anchorB);
    const double offset = pair.radial ? -p.shape.radiusB : p.gapAtStart;
    visit.gap[k] = (visit.armB[k] - matter).dot(visit.n) + offset;
    visit.corrects = visit.corrects || p.gapAtStart < -kNoError;
    active = active || visit.gap[k] < 0 || p.normalTotal > 0;
  }
  return active;
}

// One direction at one point: J, M^-1 J^T and A.
struct Direction {
  Vec3 d, a, b, wa, wb;
  double resistance;
};

Direction directionAt(const Visit& visit, int k, const Vec3& d, const Bodies& bodies,
                      const ContactPair& pair) {
  Direction row;
  row.d = d;
  row.a = visit.armA[k].cross(d);
  row.b = visit.armB[k].cross(d);
  row.wa = bodies.inverse[pair.a].inertia * row.a;
  row.wb = bodies.inverse[pair.b].inertia * row.b;
  row.resistance = visit.inverseMass + row.a.dot(row.wa) + row.b.dot(row.wb);
  return row;
}

// J dX of a push, and of the corrections made before this visit.
double moved(const Visit& visit, const Direction& row, const Push& push) {
  return visit.inverseMass * push.impulse.dot(row.d) + row.a.dot(push.turnA) +
         row.b.dot(push.turnB);
}
double corrected(const Visit& visit, const Direction& row) {
  return row.d.dot(visit.correctionX) + row.a.dot(visit.correctionA) - row.b.dot(visit.correctionB);
}

void add(Push& push, const Direction& row, double change) {
  push.impulse += change * row.d;
  push.turnA += change * row.wa;
  push.turnB += change * row.wb;
}

// (95) on the total: lambda <- max(lambda - xi c / A, 0).
void solveNormal(ContactPointState& p, double gap, const Direction& row, double xi,
                 double allowance, Visit& visit) {
  if (!(row.resistance > 1e-300)) return;
  double c = gap + moved(visit, row, visit.lasting);
  if (visit.corrects) {
    const double already = corrected(visit, row);
    const double standing = std::clamp(p.gapAtStart, -allowance, 0.0) + already;
    const double error = (p.gapAtStart > 0 ? p.gapAtStart : 0) + standing;
    const double next =
        std::max(p.normalOnce - xi * (error + moved(visit, row, visit.once)) / row.resistance, 0.0);
    add(visit.once, row, next - p.normalOnce);
    p.normalOnce = next;
    c -= std::min(p.gapAtStart, 0.0) + already;
  }
  const double next = std::max(p.normalTotal - xi * c / row.resistance, 0.0);
  add(visit.lasting, row, next - p.normalTotal);
  p.normalTotal = next;
}

// (101): within nu_s N it sticks, beyond it slides with nu_d N.
bool clampFriction(Vec2& total, const Friction& friction, double normal) {
  const double squared = total.squaredNorm(), limit = friction.staticCoefficient * normal;
  if (squared <= limit * limit) return true;
  total *= friction.dynamicCoefficient * normal / std::sqrt(squared);
  return false;
}

struct FrictionRows {
  Direction r1, r2;
  double k12, determinant;
};

// One solve of the two rows for error (c1, c2), on `total`; true while it sticks.
bool solveTangent(const FrictionRows& rows, double c1, double c2, const Friction& friction,
                  double normal, double xi, Vec3& total, Push& push) {
  const Vec2 before(total.dot(rows.r1.d), total.dot(rows.r2.d));
  Vec2 next = before - xi / rows.determinant *
                           Vec2(rows.r2.resistance * c1 - rows.k12 * c2,
                                rows.r1.resistance * c2 - rows.k12 * c1);  // (100)
  const bool sticks = clampFriction(next, friction, normal);
  total = next.x() * rows.r1.d + next.y() * rows.r2.d;
  add(push, rows.r1, next.x() - before.x());
  add(push, rows.r2, next.y() - before.y());
  return sticks;
}

void solveFriction(const ContactPair& pair, ContactPointState& p, int k, const Bodies& bodies,
                   double xi, Visit& visit) {
  FrictionRows rows{directionAt(visit, k, visit.t1, bodies, pair),
                    directionAt(visit, k, visit.t2, bodies, pair), 0, 0};
  rows.k12 = rows.r1.a.dot(rows.r2.wa) + rows.r1.b.dot(rows.r2.wb);
  rows.determinant = rows.r1.resistance * rows.r2.resistance - rows.k12 * rows.k12;
  if (!(rows.determinant > 1e-300)) return;
  const Vec3 onA = p.shape.radiusA == 0 ? visit.armA[k] : Vec3(visit.rotationA * p.anchorA);
  const Vec3 dp = visit.armB[k] - visit.armA[k] + onA - visit.rotationB * p.anchorB;
  double c1 = dp.dot(visit.t1) + moved(visit, rows.r1, visit.lasting);
  double c2 = dp.dot(visit.t2) + moved(visit, rows.r2, visit.lasting);
  if (visit.corrects || !p.slip.isZero(0)) {
    const double done1 = corrected(visit, rows.r1), done2 = corrected(visit, rows.r2);
    solveTangent(rows, p.slip.dot(visit.t1) + done1 + moved(visit, rows.r1, visit.once),
                 p.slip.dot(visit.t2) + done2 + moved(visit, rows.r2, visit.once), pair.friction,
                 p.normalTotal, xi, p.frictionOnce, visit.once);
    c1 -= done1;
    c2 -= done2;
  }
  p.sticking =
      solveTangent(rows, c1, c2, pair.friction, p.normalTotal, xi, p.frictionTotal, visit.lasting);
}

void displacePair(const ContactPair& pair, const Push& lasting, const Push& once, bool corrects,
                  Bodies& bodies) {
  const double ma = bodies.inverse[pair.a].m, mb = bodies.inverse[pair.b].m;
  bodies.shift[pair.a] += ma * lasting.impulse;
  bodies.shift[pair.b] -= mb * lasting.impulse;
  Push sum = lasting;
  if (corrects) {
    Correction &a = bodies.correction[pair.a], &b = bodies.correction[pair.b];
    a.dx += ma * once.impulse;
    b.dx -= mb * once.impulse;
    a.dtheta += once.turnA;
    b.dtheta -= once.turnB;
    sum.impulse += once.impulse;
    sum.turnA += once.turnA;
    sum.turnB += once.turnB;
  }
  displace(bodies.pose[pair.a], ma * sum.impulse, sum.turnA);
  displace(bodies.pose[pair.b], -mb * sum.impulse, -sum.turnB);
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
  Push push;
  for (int k = 0; k < pair.count; ++k) {
    ContactPointState& p = pair.points[k];
    // The smaller of the last two: an impact is over after one substep and must not be guessed
    // again.
    const double first = warm ? std::min(p.normalTotal, p.normalBefore) : 0;
    const double share = p.normalTotal > 0 ? first / p.normalTotal : 0;
    p.normalBefore = p.normalTotal;
    p.normalTotal = first;
    p.frictionTotal = share * (p.frictionTotal - p.frictionTotal.dot(n) * n);
    p.normalOnce = 0;
    p.frictionOnce.setZero();
    const Vec3 onA = p.normalTotal * n + p.frictionTotal;
    const Vec3 armA = a.q * p.anchorA;
    push.impulse += onA;
    push.turnA += armA.cross(onA);
    push.turnB += (armA + a.x - b.x).cross(onA);
  }
  if (push.impulse.isZero(0)) return;
  push.turnA = bodies.inverse[pair.a].inertia * push.turnA;
  push.turnB = bodies.inverse[pair.b].inertia * push.turnB;
  displacePair(pair, push, {}, false, bodies);
}

bool solve(ContactPair& pair, Bodies& bodies, double xi, double allowance) {
  Visit visit = beginVisit(pair, bodies);
  if (!evaluateGaps(pair, bodies, visit)) return true;
  for (int k = 0; k < pair.count; ++k) {
    const Direction row = directionAt(visit, k, visit.n, bodies, pair);
    solveNormal(pair.points[k], visit.gap[k], row, xi, allowance, visit);
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
  const Push &lasting = visit.lasting, &once = visit.once;
  const double sum = lasting.impulse.sum() + lasting.turnA.sum() + lasting.turnB.sum() +
                     once.impulse.sum() + once.turnA.sum() + once.turnB.sum();
  if (!std::isfinite(sum)) return false;
  displacePair(pair, lasting, once, visit.corrects, bodies);
  return true;
}

}  // namespace physics
