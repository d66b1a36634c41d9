// Contact: the solve of one manifold.
#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "physics/constraints/contact.h"
#include "physics/constraints/friction.h"

namespace physics {
namespace {

// Impulses, times h^2, on a at points of contact, and the turn they give a; b gets the opposite: it
// moves by -impulse/m_b and turns by -turnB.
struct Step {
  Vec3 impulse = Vec3::Zero();
  Vec3 turnA = Vec3::Zero(), turnB = Vec3::Zero();
};

// What one visit to a pair works on.
struct Visit {
  Vec3 n, t1, t2;
  Mat3 rotationA, rotationB;
  double inverseMass;  // 1/m_a + 1/m_b
  Step lasting, once;  // of this visit: of the motion, and of what stood wrong at the start
  Vec3 correctionX, correctionA, correctionB;  // corrections before this visit, b against a; turns
  bool corrects = false;                       // something stood wrong here, or nearby
  std::array<Vec3, Manifold::kMaxPoints> armA, armB;  // p_a from either centre
  std::array<double, Manifold::kMaxPoints> gap;
};

// Where a loaded contact is left alone: it neither falls through a gap nor is pushed out of an
// overlap smaller than this. Errors that small are not worth setting a body in motion.
constexpr double kTouching = 1e-4;  // m

// How often over a contact may push to take back its own overlap. Overlaps that contradict each
// other (a box over-full) would push without bounds, and the last visited would win; so they push
// in proportion to their depth.
constexpr double kFirmness = 6;

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
    const double offset = pair.radial ? -p.shape.radiusB : p.gapAtAnchors;
    visit.gap[k] = (visit.armB[k] - matter).dot(visit.n) + offset;
    visit.corrects = visit.corrects || p.gapAtStart < -kTouching || !p.slip.isZero(0);
    active = active || visit.gap[k] < 0 || p.normalTotal != 0;
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
double moved(const Visit& visit, const Direction& row, const Step& push) {
  return visit.inverseMass * push.impulse.dot(row.d) + row.a.dot(push.turnA) +
         row.b.dot(push.turnB);
}
double corrected(const Visit& visit, const Direction& row) {
  return row.d.dot(visit.correctionX) + row.a.dot(visit.correctionA) - row.b.dot(visit.correctionB);
}

void add(Step& push, const Direction& row, double change) {
  push.impulse += change * row.d;
  push.turnA += change * row.wa;
  push.turnB += change * row.wb;
}

// (95) on the total: lambda <- max(lambda - xi c / A, 0).
void solveNormal(ContactPointState& p, double gap, const Direction& row, double xi,
                 double allowance, Visit& visit) {
  if (!(row.resistance > 1e-300)) return;
  double c = gap + moved(visit, row, visit.lasting);
  if (p.gapAtStart < 0 || (p.loaded && p.gapAtStart < kTouching)) c -= p.gapAtStart;
  if (visit.corrects) {
    const double already = corrected(visit, row);
    const double error =
        std::max(p.gapAtStart + kTouching, -allowance) + already + moved(visit, row, visit.once);
    const double most = kFirmness * std::max(allowance, -p.gapAtStart) / row.resistance;
    const double next = std::clamp(p.normalOnce - xi * error / row.resistance, 0.0, most);
    add(visit.once, row, next - p.normalOnce);
    p.normalOnce = next;
    c -= already;
  }
  const double next = std::max(p.normalTotal - xi * c / row.resistance, 0.0);
  add(visit.lasting, row, next - p.normalTotal);
  p.normalTotal = next;
}

struct FrictionRows {
  Direction r1, r2;
  double k12, determinant;
};

// One solve of the two rows for error c, on `total`; true while it sticks (101). Sticking takes the
// full step. Sliding takes the step along c, (99),(100): there friction must oppose the slip, and
// the full step would turn it towards where the bodies give way most.
bool solveTangent(const FrictionRows& rows, const Vec2& c, const Friction& friction, double normal,
                  double xi, Vec3& total, Step& push) {
  const double k11 = rows.r1.resistance, k22 = rows.r2.resistance, k12 = rows.k12;
  const Vec2 before(total.dot(rows.r1.d), total.dot(rows.r2.d));
  Vec2 next =
      before - xi / rows.determinant * Vec2(k22 * c.x() - k12 * c.y(), k11 * c.y() - k12 * c.x());
  const double limit = friction.staticCoefficient * normal;
  const bool sticks = next.squaredNorm() <= limit * limit;
  if (!sticks) {
    const double stiffest = 0.5 * (k11 + k22) + std::hypot(0.5 * (k11 - k22), k12);
    next = before - xi / stiffest * c;
    next *= heldShare(friction, next.norm(), normal);
  }
  total = next.x() * rows.r1.d + next.y() * rows.r2.d;
  add(push, rows.r1, next.x() - before.x());
  add(push, rows.r2, next.y() - before.y());
  return sticks;
}

double solveFriction(const ContactPair& pair, ContactPointState& p, int k, const Bodies& bodies,
                     double xi, Visit& visit) {
  FrictionRows rows{directionAt(visit, k, visit.t1, bodies, pair),
                    directionAt(visit, k, visit.t2, bodies, pair), 0, 0};
  rows.k12 = rows.r1.a.dot(rows.r2.wa) + rows.r1.b.dot(rows.r2.wb);
  rows.determinant = rows.r1.resistance * rows.r2.resistance - rows.k12 * rows.k12;
  if (!(rows.determinant > 1e-300)) return 0;
  const Vec3 before = p.frictionTotal;
  const Vec3 onA = p.shape.radiusA == 0 ? visit.armA[k] : Vec3(visit.rotationA * p.anchorA);
  const Vec3 dp = visit.armB[k] - visit.armA[k] + onA - visit.rotationB * p.anchorB;
  Vec2 c(dp.dot(visit.t1) + moved(visit, rows.r1, visit.lasting),
         dp.dot(visit.t2) + moved(visit, rows.r2, visit.lasting));
  if (visit.corrects) {
    const Vec2 done(corrected(visit, rows.r1), corrected(visit, rows.r2));
    const Vec2 standing(p.slip.dot(visit.t1) + done.x() + moved(visit, rows.r1, visit.once),
                        p.slip.dot(visit.t2) + done.y() + moved(visit, rows.r2, visit.once));
    solveTangent(rows, standing, pair.friction, p.normalTotal, xi, p.frictionOnce, visit.once);
    c -= done;
  }
  p.sticking =
      solveTangent(rows, c, pair.friction, p.normalTotal, xi, p.frictionTotal, visit.lasting);
  return (p.frictionTotal - before).norm() * rows.r1.resistance;
}

void displacePair(const ContactPair& pair, const Step& lasting, const Step& once, bool corrects,
                  Bodies& bodies) {
  const double ma = bodies.inverse[pair.a].m, mb = bodies.inverse[pair.b].m;
  bodies.shift[pair.a] += ma * lasting.impulse;
  bodies.shift[pair.b] -= mb * lasting.impulse;
  Step sum = lasting;
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

// Keeps the account of angular impulses that the second-order steppings balance.
void countTwist(const ContactPair& pair, const Visit& visit,
                const std::array<Vec3, Manifold::kMaxPoints>& before, Bodies& bodies) {
  for (int k = 0; k < pair.count; ++k) {
    const ContactPointState& p = pair.points[k];
    const Vec3 impulse = p.normalTotal * visit.n + p.frictionTotal - before[k];
    bodies.second.twist[pair.a] += visit.armA[k].cross(impulse);
    bodies.second.twist[pair.b] -= visit.armB[k].cross(impulse);
  }
}

double solveNormals(ContactPair& pair, Bodies& bodies, double xi, double allowance, bool backward,
                    Visit& visit) {
  double largest = 0;
  for (int i = 0; i < pair.count; ++i) {
    const int k = backward ? pair.count - 1 - i : i;
    ContactPointState& p = pair.points[k];
    const Direction row = directionAt(visit, k, visit.n, bodies, pair);
    p.resistance = row.resistance;
    const double before = p.normalTotal;
    solveNormal(p, visit.gap[k], row, xi, allowance, visit);
    largest = std::max(largest, std::abs(p.normalTotal - before) * row.resistance);
  }
  return largest;
}

double solveFrictions(ContactPair& pair, Bodies& bodies, double xi, bool backward, Visit& visit) {
  if (!pair.frictional) return 0;
  double largest = 0;
  visit.t1 = anyNormalTo(visit.n);
  visit.t2 = visit.n.cross(visit.t1);
  for (int i = 0; i < pair.count; ++i) {
    const int k = backward ? pair.count - 1 - i : i;
    ContactPointState& p = pair.points[k];
    if (p.normalTotal > 0 || !p.frictionTotal.isZero(0))
      largest = std::max(largest, solveFriction(pair, p, k, bodies, xi, visit));
  }
  return largest;
}

}  // namespace

double solve(ContactPair& pair, Bodies& bodies, double xi, double allowance, bool backward) {
  Visit visit = beginVisit(pair, bodies);
  if (!evaluateGaps(pair, bodies, visit)) return 0;
  std::array<Vec3, Manifold::kMaxPoints> before;
  for (int k = 0; k < pair.count && !bodies.second.empty(); ++k) {
    before[k] = pair.points[k].normalTotal * visit.n + pair.points[k].frictionTotal;
  }
  double largest = 0;
  if (backward) largest = solveFrictions(pair, bodies, xi, backward, visit);
  largest = std::max(largest, solveNormals(pair, bodies, xi, allowance, backward, visit));
  if (!backward) largest = std::max(largest, solveFrictions(pair, bodies, xi, backward, visit));
  const Step &lasting = visit.lasting, &once = visit.once;
  const double sum = lasting.impulse.sum() + lasting.turnA.sum() + lasting.turnB.sum() +
                     once.impulse.sum() + once.turnA.sum() + once.turnB.sum();
  if (!std::isfinite(sum)) return sum - sum;
  displacePair(pair, lasting, once, visit.corrects, bodies);
  pair.given += lasting.impulse;
  if (!bodies.second.empty()) countTwist(pair, visit, before, bodies);
  return largest;
}

}  // namespace physics
