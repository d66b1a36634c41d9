// The World's self-check: every gradient against central differences of its coordinate.
#include <cmath>

#include "physics/world/impl.h"

namespace physics {
namespace {

constexpr double kStep = 1e-6;  // m, rad: truncation 1e-12 of the third derivative, rounding 1e-10

template <class C>
Evaluated<C> evaluated(const C& item, const std::vector<Pose>& pose, const WorldState& w) {
  Evaluated<C> row;
  item.evaluate({pose, w.bodies.start, w.substepLength()}, row);
  return row;
}

// Central difference of c by a displacement of one body along coordinate k: 0..2 dx, 3..5 a turn.
template <class C>
VectorOf<C> difference(const C& item, std::vector<Pose>& pose, BodyId body, int k,
                       const WorldState& w) {
  Vec3 dx = Vec3::Zero(), turn = Vec3::Zero();
  (k < 3 ? dx : turn)[k % 3] = kStep;
  const Pose here = pose[body];
  VectorOf<C> sum = VectorOf<C>::Zero();
  for (const double side : {1.0, -1.0}) {
    displace(pose[body], side * dx, side * turn);
    sum += side * evaluated(item, pose, w).c;
    pose[body] = here;
  }
  return sum / (2 * kStep);
}

// A one-sided row that has nothing to do needs no gradient, and a limit may have none at its
// middle.
template <class C>
bool isAtWork(const Evaluated<C>& row) {
  if constexpr (!Force<C>) {
    if (row.high <= 0 && (row.c.array() <= 0).all()) return false;
    if (row.low >= 0 && (row.c.array() >= 0).all()) return false;
  }
  return row.active;
}

template <class C>
double deviation(const C& item, std::vector<Pose>& pose, const WorldState& w) {
  const auto row = evaluated(item, pose, w);
  if (!isAtWork<C>(row)) return 0;
  double worst = 0, largest = 0;
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    for (int k = C::kLinear ? 0 : 3; k < (isAngular<C>() ? 6 : 3); ++k) {
      const auto& block = k < 3 ? row.linear[b] : row.angular[b];
      const auto wrong = (block.col(k % 3) - difference(item, pose, item.bodies[b], k, w)).eval();
      worst = std::max(worst, wrong.cwiseAbs().maxCoeff());
      largest = std::max(largest, block.col(k % 3).cwiseAbs().maxCoeff());
    }
  }
  return largest > 0 ? worst / largest : worst;
}

// A contact's gap: n on a and -n on b, both at the point p_a.
double contactDeviation(const ContactPair& pair, int k, std::vector<Pose>& pose) {
  const Vec3 n = normalOf(pair, pose), p = pointOf(pair, k, pose);
  double worst = 0, largest = 1;  // |n|
  for (const auto& [body, sign] : {std::pair{pair.a, 1.0}, std::pair{pair.b, -1.0}}) {
    const Vec3 turn = (p - pose[body].x).cross(n);
    largest = std::max(largest, turn.norm());
    for (int i = 0; i < 6; ++i) {
      Vec3 dx = Vec3::Zero(), dtheta = Vec3::Zero();
      (i < 3 ? dx : dtheta)[i % 3] = kStep;
      const Pose here = pose[body];
      displace(pose[body], dx, dtheta);
      const double ahead = gapOf(pair, k, pose);
      pose[body] = here;
      displace(pose[body], -dx, -dtheta);
      const double behind = gapOf(pair, k, pose);
      pose[body] = here;
      const double wanted = sign * (i < 3 ? n : turn)[i % 3];
      worst = std::max(worst, std::abs(wanted - (ahead - behind) / (2 * kStep)));
    }
  }
  return worst / largest;
}

// An arm's error by a turn of each joint, (152), against differences of the posture.
double armDeviation(const DrivenArm& driven) {
  const ArmPosture posture = postureOf(driven.arm);
  const TipError error = tipError(posture, driven.target);
  double worst = 0, largest = 0;
  for (int k = 0; error.c > 0 && k < driven.arm.size(); ++k) {
    const Vec3 gradient = gradientOf(posture, k, error.n);
    const Quat& parent = parentOf(driven.arm, posture, k);
    const auto turned = [&](const Vec3& turn) {  // a world-frame turn of all beyond pivot k
      Arm arm = driven.arm;
      arm.joints[k].turn = parent.conjugate() * exponential(turn) * parent * arm.joints[k].turn;
      return tipError(postureOf(arm), driven.target).c;
    };
    for (int i = 0; i < 3; ++i) {
      const Vec3 step = kStep * Vec3::Unit(i);
      worst = std::max(worst, std::abs(gradient[i] - (turned(step) - turned(-step)) / (2 * kStep)));
      largest = std::max(largest, std::abs(gradient[i]));
    }
  }
  return largest > 0 ? worst / largest : worst;
}

}  // namespace

double World::gradientError() const {
  std::vector<Pose> pose = impl_->bodies.pose;
  double worst = 0;
  forEachKind(impl_->kinds, [&](const auto& kind) {
    for (const auto& item : kind.set.items) {
      worst = std::max(worst, deviation(item, pose, *impl_));
    }
  });
  for (const ContactPair& pair : impl_->contacts.pairs) {
    for (int k = 0; k < pair.count; ++k) {
      worst = std::max(worst, contactDeviation(pair, k, pose));
    }
  }
  for (const DrivenArm& driven : impl_->arms) worst = std::max(worst, armDeviation(driven));
  return worst;
}

}  // namespace physics
