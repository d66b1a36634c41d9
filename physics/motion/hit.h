// A hit of two bodies that touch: impulses along their normal at each point and of friction, in no
// time. It has the friction of Coulomb's law for all that presses, where it presses, but no more
// than leaves the pair without a gain: what an impulse p adds is p . (v- + v+) / 2, and along
// normals that is not above zero where they come apart no faster than they came.
#pragma once

#include <array>

#include "physics/constraints/contact.h"

namespace physics {

inline constexpr double kSlowest = 1e-9;  // m/s: slower than this is rounding

// What an impulse of 1 along a direction at a point does to a pair.
struct Lever {
  Vec3 n = Vec3::Zero(), wa = Vec3::Zero(), wb = Vec3::Zero();  // turns: I^-1 (r x n)
  Vec3 na = Vec3::Zero(), nb = Vec3::Zero();                    // r x n
  double resistance = 0;
};

Lever leverOf(const ContactPair& pair, const Vec3& point, const Vec3& n, const Bodies& bodies);
Lever leverOf(const ContactPair& pair, int point, const Bodies& bodies);  // along the normal

// A pair that touches, and where.
struct Meeting {
  struct Set {  // of points: 1 for those that are in, and what `gives` is inverse to there
    Eigen::Vector4d in = Eigen::Vector4d::Zero();
    Eigen::Matrix4d inverse = Eigen::Matrix4d::Zero();
  };
  const ContactPair* pair = nullptr;
  std::array<bool, Manifold::kMaxPoints> touches{};
  std::array<Lever, Manifold::kMaxPoints> levers{};  // of the points that touch
  // The speed at point i of an impulse of 1 at j [1/kg].
  Eigen::Matrix4d gives = Eigen::Matrix4d::Zero();
  Set last;  // that pushed
};

void takeLevers(Meeting& meeting, const Bodies& bodies);  // for as long as the poses stand

// Along the normal of each point that touches; 0 at others [m/s].
Eigen::Vector4d speedsOf(const Meeting& meeting, const Bodies& bodies);

// Velocities jump, so that points that are at `speed` along the normal are at `then`, or faster
// where nothing pushes them [m/s].
void hit(Meeting& meeting, const Eigen::Vector4d& speed, const Eigen::Vector4d& then,
         Bodies& bodies);

}  // namespace physics
