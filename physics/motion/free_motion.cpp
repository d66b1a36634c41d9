// Free motion and the velocities at the end of a substep.
#include "physics/motion/free_motion.h"

#include <array>
#include <cmath>

#include "physics/base/inverse.h"
#include "physics/base/rotation.h"

namespace physics {
namespace {

// Beyond this turn per substep n . M~^-1 n may become negative: a constraint would pull the wrong
// way. NOTES 3.2
constexpr double kLargestTurn = 0.2;  // rad

void turnFreely(Bodies& bodies, int i, const Vec3& torque, double dt) {
  Pose& pose = bodies.pose[i];
  Vec3& w = bodies.velocity[i].w;
  if (!bodies.general && isIsotropic(bodies.inertia[i])) {  // the gyroscopic torque is zero
    w += dt * bodies.inverseInertia[i].x() * torque;        // (30)
    bodies.freeTurn[i] = dt * w;
  } else {
    const Mat3 rotation = pose.q.toRotationMatrix();
    Vec3 omega = rotation.transpose() * w;
    omega += dt * bodies.inverseInertia[i].cwiseProduct(rotation.transpose() * torque);
    const FreeTurn turn = freeTurn(bodies.inertia[i], omega, dt);
    bodies.freeTurn[i] = dt * (rotation * turn.mean);
    w = exponential(bodies.freeTurn[i]) * (rotation * turn.after);
  }
  pose.q = exponential(bodies.freeTurn[i]) * pose.q;  // (31)
}

// (D + [b]x)^-1 r. The determinant is a sum of what is positive: D's and b . D b.
Vec3 solveDiagonalAndCross(const Vec3& d, const Vec3& b, const Vec3& r) {
  const Vec3 db = d.cwiseProduct(b);
  const Vec3 minors(d.y() * d.z(), d.z() * d.x(), d.x() * d.y());
  return (minors.cwiseProduct(r) + b.dot(r) * b - db.cross(r)) / (d.prod() + b.dot(db));
}

// exp(-theta) and its derivative, by Rodrigues' formula: I - sine [theta]x + cosine [theta]x^2.
struct BackTurn {
  Vec3 theta;
  double sine, cosine, third;  // sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3

  explicit BackTurn(const Vec3& turn) : theta(turn) {
    const double x = theta.squaredNorm();
    if (x <= 1) {  // what is left of the series is below 1e-18
      cosine = seriesOf<2>(x);
      third = seriesOf<3>(x);
      sine = 1 - x * third;
    } else {
      const double angle = std::sqrt(x);
      const SineCosine of = sineCosine(angle);
      sine = of.sine / angle;
      cosine = (1 - of.cosine) / x;
      third = (1 - sine) / x;
    }
  }
  // 1/n! - x/(n + 2)! + x^2/(n + 4)! - ...
  template <int n>
  static double seriesOf(double x) {
    constexpr int kTerms = 9;  // 1 / 20! is below 1e-18
    constexpr std::array<double, kTerms> factors = [] {
      std::array<double, kTerms> of{};
      double factorial = 1;
      for (int k = 2; k <= n; ++k) factorial *= k;
      for (int k = 0; k < kTerms; ++k) {
        of[static_cast<std::size_t>(k)] = (k % 2 == 0 ? 1 : -1) / factorial;
        factorial *= (n + 2 * k + 1) * (n + 2 * k + 2);
      }
      return of;
    }();
    double sum = factors[kTerms - 1];
    for (std::size_t k = kTerms - 1; k-- > 0;) sum = sum * x + factors[k];
    return sum;
  }

  Vec3 of(const Vec3& m) const {
    const Vec3 across = theta.cross(m);
    return m - sine * across + cosine * theta.cross(across);
  }
  // What `after` = of(m) changes by with theta: [after]x (I - cosine [theta]x + third [theta]x^2).
  Mat3 derivative(const Vec3& after) const {
    const double x = theta.squaredNorm();
    Mat3 left = third * theta * theta.transpose() - cosine * skew(theta);
    left.diagonal().array() += 1 - third * x;
    return skew(after) * left;
  }
};

constexpr double kTurnRounding = 4e-16;  // of a momentum: two roundings

// Newton on F(Omega_m) = I Omega_m - (1 - e) M - e exp(-h Omega_m) M. Where its derivative is not
// regular, the first order of it in h is: I - e h [M']x.
FreeTurn solveTurn(const Vec3& inertia, const Vec3& omega, double dt, double end,
                   const Vec3& guess) {
  constexpr int kMostIterations = 30;  // Newton doubles its digits: more do not converge
  const Vec3 momentum = inertia.cwiseProduct(omega);
  const double scale = momentum.norm();
  // About a principal axis it goes on as it is.
  const double turned = dt * omega.cross(momentum).norm();
  if (scale == 0 || turned <= kTurnRounding * scale) return {omega, omega, true};
  FreeTurn turn{guess, omega, true};
  for (int k = 0; k < kMostIterations; ++k) {
    const BackTurn back(dt * turn.mean);
    const Vec3 after = back.of(momentum);
    const Vec3 residual = inertia.cwiseProduct(turn.mean) - ((1 - end) * momentum + end * after);
    // Half of the digits where rounding keeps it from getting there.
    if (residual.norm() <= kTurnRounding * scale || k == kMostIterations - 1) {
      turn.converged = residual.norm() <= 1e-9 * scale;
      turn.after = after.cwiseQuotient(inertia);
      break;
    }
    Mat3 jacobian = -end * dt * back.derivative(after);
    jacobian.diagonal() += inertia;
    const Vec3 minor = jacobian.col(1).cross(jacobian.col(2));
    const double determinant = minor.dot(jacobian.col(0));
    if (determinant > 0) {
      turn.mean -= Vec3(minor.dot(residual), jacobian.col(2).cross(jacobian.col(0)).dot(residual),
                        jacobian.col(0).cross(jacobian.col(1)).dot(residual)) /
                   determinant;
    } else {
      turn.mean -= solveDiagonalAndCross(inertia, -end * dt * after, residual);
    }
  }
  return turn;
}

// One turn after the other; the mean is that of a steady turn which ends at the same orientation.
FreeTurn solveParts(const Vec3& inertia, const Vec3& omega, double dt, int parts) {
  FreeTurn whole{Vec3::Zero(), omega, true};
  Quat turned = Quat::Identity();
  for (int k = 0; k < parts && whole.converged; ++k) {
    const FreeTurn part = solveTurn(inertia, whole.after, dt / parts, 0.5, whole.after);
    turned = turned * exponential(dt / parts * part.mean);
    whole = {whole.mean + part.mean / parts, part.after, part.converged};
  }
  whole.mean = unwrapped(logarithm(turned.normalized()), dt * whole.mean) / dt;
  return whole;
}

}  // namespace

bool isIsotropic(const Vec3& inertia) {
  return inertia.x() == inertia.y() && inertia.y() == inertia.z();
}

Vec3 unwrapped(const Vec3& turn, const Vec3& free) {
  const double angle = turn.norm();
  // Within 1 rad no whole turn is missing; of a turn that is rounding there is no axis.
  if (angle < 1e-9 || free.squaredNorm() < 1) return turn;
  const Vec3 axis = turn / angle;
  return (angle + 2 * kPi * std::nearbyint((free.dot(axis) - angle) / (2 * kPi))) * axis;
}

FreeTurn freeTurn(const Vec3& inertia, const Vec3& omega, double dt, double end) {
  return freeTurn(inertia, omega, dt, end, omega);
}

FreeTurn freeTurn(const Vec3& inertia, const Vec3& omega, double dt, double end,
                  const Vec3& guess) {
  constexpr int kMostParts = 4096;  // a guard: a spin that needs more is told
  FreeTurn turn = solveTurn(inertia, omega, dt, end, guess);
  for (int parts = 2; !turn.converged && end == 0.5 && parts <= kMostParts; parts *= 2) {
    turn = solveParts(inertia, omega, dt, parts);
  }
  return turn.converged ? turn : FreeTurn{omega, omega, false};
}

void moveFreely(Bodies& bodies, BodyId i, const Load& load, const std::optional<Vec3>& gravity,
                double dt) {
  bodies.start[i] = bodies.pose[i];
  if (bodies.motion[i] == Motion::kStatic) return;
  Velocity& velocity = bodies.velocity[i];
  bodies.shift[i].setZero();
  if (bodies.motion[i] == Motion::kDynamic) {
    if (gravity) velocity.v += dt * *gravity;  // (28)
    velocity.v += dt * bodies.inverse[i].m * load.force;
  }
  bodies.pose[i].x += dt * velocity.v;  // (29)
  if (bodies.inverseInertia[i].isZero(0)) {
    bodies.freeTurn[i] = dt * velocity.w;
    if (!velocity.w.isZero(0)) bodies.pose[i].q = exponential(dt * velocity.w) * bodies.pose[i].q;
  } else {
    turnFreely(bodies, i, load.torque, dt);
  }
}

void moveFreely(Bodies& bodies, std::span<const Load> loads, const std::optional<Vec3>& gravity,
                double dt) {
  for (const BodyId i : bodies.active) moveFreely(bodies, i, loads[i], gravity, dt);
}

void finishVelocity(Bodies& bodies, BodyId i, double dt) {
  if (bodies.motion[i] != Motion::kDynamic) return;
  bodies.velocity[i].v += bodies.shift[i] / dt;  // (43)
  if (bodies.inverseInertia[i].isZero(0)) return;
  bodies.pose[i].q.normalize();
  const Vec3 turn =
      unwrapped(logarithm(bodies.pose[i].q * bodies.start[i].q.conjugate()), bodies.freeTurn[i]);
  if (!bodies.general && isIsotropic(bodies.inertia[i])) {
    bodies.velocity[i].w = turn / dt;  // bounded by pi/h, where the sum (45) is not; paper.md
  } else {
    bodies.velocity[i].w += (turn - bodies.freeTurn[i]) / dt;
  }
}

void finishVelocities(Bodies& bodies, double dt) {
  for (const BodyId i : bodies.active) finishVelocity(bodies, i, dt);
}

void refreshInertia(Bodies& bodies) {
  for (const BodyId i : bodies.anisotropic) {
    const Mat3 rotation = bodies.pose[i].q.toRotationMatrix();
    bodies.inverse[i].inertia =
        rotation * bodies.inverseInertia[i].asDiagonal() * rotation.transpose();
  }
}

// The second term is half that of (65), because velocities come from the quaternion's logarithm
// and not from (45). NOTES 3.2
void refreshSpinInertia(Bodies& bodies, double dt) {
  refreshInertia(bodies);
  for (const BodyId i : bodies.anisotropic) {
    const Vec3 turn = dt * bodies.velocity[i].w;
    if (bodies.motion[i] != Motion::kDynamic || turn.norm() > kLargestTurn) continue;
    const Mat3 rotation = bodies.pose[i].q.toRotationMatrix();
    const Mat3 inertia = rotation * bodies.inertia[i].asDiagonal() * rotation.transpose();
    const Mat3 spinning = inertia - skew(inertia * turn) + 0.5 * inertia * skew(turn);
    bodies.inverse[i].inertia = inverseOrNan(spinning);
  }
}

void bringToRest(Bodies& bodies) {
  for (const BodyId i : bodies.active) {
    if (bodies.motion[i] == Motion::kDynamic) bodies.velocity[i] = {};
  }
}

}  // namespace physics
