// Contact and Coulomb friction between two bodies, a manifold of up to four points at a time.
//   normal    c = (p_a - p_b) . n >= 0 [m]    total lambda_n >= 0                 (91)-(95)
//   corrected friction  c = (1 - n n^T)[(p_a - p_b)(now) - (p_a - p_b)(start of the substep)] [m],
//   along it,
//             |lambda_t| <= nu_s lambda_n, else nu_d lambda_n                            (96)-(101)
// p_a, p_b are points of the bodies' matter that coincide in the plane at the start of the substep.
// Both rows act at p_a on either body: impulses are equal, opposite and at one place, and turn
// nothing that they should not.
#pragma once

#include <span>
#include <vector>

#include "physics/bodies/body.h"
#include "physics/collision/collider.h"

namespace physics {

struct ContactPointState {
  ContactPoint shape;
  Vec3 anchorA = Vec3::Zero(),
       anchorB = Vec3::Zero();        // body frames: the matter at p_a when the substep began
  Vec3 frictionTotal = Vec3::Zero();  // accumulated, on a, world, times h^2
  double normalTotal = 0;             // accumulated, on a along n, times h^2
  double gapAtStart = 0;              // c at the start of the substep [m]
  double approach = 0;  // normal velocity at the start of the substep [m/s], negative: closing
  Vec3 normal = Vec3::UnitY();  // world, of this substep
  bool loaded = false;          // it pushed in the last substep
  bool sticking = false;        // penalty forces only
};

struct ContactPair {
  BodyId a = 0, b = 0;
  std::uint64_t key = 0;        // Manifold::pair
  bool radial = false;          // the normal joins the two cores (sphere on sphere)
  bool carried = false;         // the normal turns with body b (its face); else fixed in the world
  Vec3 normal = Vec3::UnitY();  // body frame of b when carried, else world
  Friction friction;
  bool frictional = true;  // it has rows of friction
  double step = 0;         // that the multipliers belong to, with second-order steppings [s]
  int count = 0;
  std::array<ContactPointState, Manifold::kMaxPoints> points;
};

struct Contacts {
  std::vector<ContactPair> pairs, previous;  // sorted by key
};

bool isLoaded(const ContactPair& pair);   // some point of it pushes
Vec3 impulseOf(const ContactPair& pair);  // on a, times h^2

// Takes over what the collider found; multipliers and slips go on where pair and feature are the
// same.
void update(Contacts& contacts, std::span<const Manifold> manifolds, const Bodies& bodies);

// Anchors, gaps and speeds at bodies.start, nothing else: the rivals' start.
void measureStart(ContactPair& pair, const Bodies& bodies);

// Start of a substep: the same, and lambda = 0.
void prepare(ContactPair& pair, const Bodies& bodies);

// One visit: every normal, then every friction. False: a change was not finite.
bool solve(ContactPair& pair, Bodies& bodies, double xi);

// Present normal [world], and gap of point k at the poses.
Vec3 normalOf(const ContactPair& pair, std::span<const Pose> pose);
double gapOf(const ContactPair& pair, int k, std::span<const Pose> pose);
// Where the surface of a is, at point k [world].
Vec3 pointOf(const ContactPair& pair, int k, std::span<const Pose> pose);

}  // namespace physics
