// Contact and Coulomb friction between two bodies, a manifold of up to four points at a time.
//   normal    c = (p_a - p_b) . n >= 0 [m]    total lambda_n >= 0                       (91)-(95)
//   corrected friction  c = slip + (1 - n n^T)[(p_a - p_b)(now) - (p_a - p_b)(start of the
//   substep)] [m], two rows
//             |lambda_t| <= nu_s lambda_n, else nu_d lambda_n along it (96)-(101)
// p_a, p_b are points of the bodies' matter that coincide in the plane at the start of the substep;
// `slip` is what a sticking contact still has to take back, so that it does not creep. Both rows
// act at p_a on either body: impulses are equal, opposite and at one place, and turn nothing that
// they should not. An overlap or slip that stood at X^t is solved beside it by multipliers of its
// own (Correction in body.h). A manifold is one visit of the sweep: the errors are exact at the
// visit, (52), and within it the points see each other's corrections to first order.
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
  Vec3 slip = Vec3::Zero();           // m, world
  Vec3 frictionTotal = Vec3::Zero();  // accumulated, on a, world, times h^2
  double normalTotal = 0;             // accumulated, on a along n, times h^2
  Vec3 frictionOnce = Vec3::Zero();   // the same of what stood wrong at the start: slip, and
  double normalOnce = 0;              // overlap; these move bodies without speeding them
  double normalBefore = 0;            // normalTotal a substep earlier
  double gapAtStart = 0;              // c at the start of the substep [m]
  double gapAtAnchors = 0;            // c where the anchors were taken: at Bodies::start [m]
  double approach = 0;  // normal velocity at the start of the substep [m/s], negative: closing
  Vec3 normal = Vec3::UnitY();  // world, of this substep
  Vec3 extra = Vec3::Zero();    // impulse that push() applies, times h^2
  double resistance = 0;        // A of the normal row
  bool settled = false;         // its multiplier is that of rest, however new
  bool sticking = false;
  bool loaded = false;  // it starts the substep with an impulse
};

struct ContactPair {
  BodyId a = 0, b = 0;
  bool radial = false;          // the normal joins the two cores (sphere on sphere)
  bool carried = false;         // the normal turns with body b (its face); else fixed in the world
  Vec3 normal = Vec3::UnitY();  // body frame of b when carried, else world
  Friction friction;
  bool frictional = true;     // it has rows of friction
  double step = 0;            // that the multipliers belong to, with second-order steppings [s]
  Vec3 given = Vec3::Zero();  // to a in this substep, to and fro summed up, times h^2; b: opposite
  int count = 0;
  std::array<ContactPointState, Manifold::kMaxPoints> points;
};

struct Contacts {
  std::vector<ContactPair> pairs, previous;  // sorted by (a, b)
  std::vector<ContactPair> lost;  // pushed in this substep, before contacts were looked for anew
};

// visit(pair) for all that pushed in this substep; those found again may come twice.
template <class F>
void forEachPush(const Contacts& contacts, F&& visit) {
  for (const auto* pairs : {&contacts.pairs, &contacts.lost}) {
    for (const ContactPair& pair : *pairs) {
      if (!pair.given.isZero(0)) visit(pair);
    }
  }
}

// Takes over what the collider found; multipliers and slips go on where pair and feature are the
// same.
void update(Contacts& contacts, std::span<const Manifold> manifolds, const Bodies& bodies);

// Anchors, gaps and speeds at bodies.start, nothing else: for contacts found in the middle of a
// solve.
void measureStart(ContactPair& pair, const Bodies& bodies);

// Start of a substep: the same, slips, and the last multipliers are applied, as far as that moves
// no point by more than `farthest` [m].
void prepare(ContactPair& pair, Bodies& bodies, double farthest);

// Applies every point's `extra`.
void push(ContactPair& pair, Bodies& bodies);

// One visit. `allowance` [m] is how much overlap that existed at the start may be resolved in this
// substep. Returns false when a change is not finite.
double solve(ContactPair& pair, Bodies& bodies, double xi, double allowance, bool backward);

// Present normal [world], and gap of point k at the poses.
Vec3 normalOf(const ContactPair& pair, std::span<const Pose> pose);
double gapOf(const ContactPair& pair, int k, std::span<const Pose> pose);
// Where the surface of a is, at point k [world].
Vec3 pointOf(const ContactPair& pair, int k, std::span<const Pose> pose);

}  // namespace physics
