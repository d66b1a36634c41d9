// Contact and friction between a point or link of something soft and a rigid body.
//   p = (1 - t) x_0 + t x_1 on the link, a plane (p_b, n) of body b:
//   c = (p - p_b) . n - radius >= 0 [m]   dc/dx_0 = (1 - t) n, dc/dx_1 = t n, b as in (92)
//   (91)-(95) friction against the matter of b that was at p when the substep began, along the slip
//   (96)-(101)
#pragma once

#include <vector>

#include "physics/bodies/body.h"
#include "physics/collision/soft_collider.h"

namespace physics {

// Points and links that touch rigid bodies: a rope, a cloth, the skin of a soft body.
struct SoftSurfaceDef {
  std::vector<BodyId> nodes;                 // points
  std::vector<std::array<BodyId, 2>> links;  // between points
  double radius = 0.01;                      // half the thickness [m]
  Friction friction;
};

// Close to an end that is held the other end would have to leap, by 1/t of the gap: such contacts
// take smaller steps, where the resistance of the link is below this share of its ends'.
constexpr double kLeastShare = 0.05;

struct SoftContact {
  int element = 0;  // of the collider
  BodyId from = 0, to = 0, body = 0;
  double along = 0;               // t
  double radius = 0;              // m
  Vec3 onBody = Vec3::Zero();     // p_b, body frame of b
  Vec3 normal = Vec3::UnitY();    // n, body frame of b
  Vec3 anchor = Vec3::Zero();     // body frame of b: its matter at p at the start
  Vec3 startSlip = Vec3::Zero();  // p - anchor at the start, world [m]
  Friction friction;
  double gapAtStart = 0;              // m
  double normalTotal = 0;             // accumulated, times h^2
  double step = 0;                    // that h [s]; small steps only
  Vec3 frictionTotal = Vec3::Zero();  // on the soft side, world, times h^2
};

// Contacts for the places found, at bodies.start.
void startSoftContacts(std::span<const SoftTouch> touches, const SoftCollider& collider,
                       const Bodies& bodies, std::vector<SoftContact>& contacts);

// One visit. False: a change was not finite.
bool solve(SoftContact& contact, Bodies& bodies, double xi);

double gapOf(const SoftContact& contact, std::span<const Pose> pose);
Vec3 pointOf(const SoftContact& contact, std::span<const Pose> pose);  // p, world

}  // namespace physics
