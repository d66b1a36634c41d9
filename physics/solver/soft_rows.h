// Contacts of points and links with rigid bodies, as rows of a substep: prepared at X^t, with
//   c = gap + n . ((1 - t) u_0 + t u_1 - u_b) - (r x n) . theta_b,   r from b's centre
//   position   c = 0; an overlap that stood at X^t is taken back by at most `push`
//   velocity   J u = -max(c, 0), and friction on the disc of (96)-(101)
// with the total projected on lambda >= 0.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/constraints/soft_contact.h"
#include "physics/solver/articulation.h"

namespace physics {

struct SoftRow {
  BodyId from = 0, to = 0, body = 0;
  double along = 0;                               // t
  double first = 0, second = 0, inverseMass = 0;  // 1/m of from, to, body
  Vec3 n, arm;
  Mat3 inertia;        // of body, inverse
  double inverse = 0;  // 1/A
  double gap = 0, open = 0, lambda = 0, next = 0;
  Eigen::Matrix<double, 3, 2> tangents;
  Eigen::Matrix2d tangentInverse;
  Eigen::Vector2d friction;
  Friction coefficients;
  bool owned = false;    // its normal row is solved with those of a deformable
  bool held = true;      // there: at its bound
  bool isTried = false;  // there: it was set free in this solve and held again
};

// What p on the soft side moves by against the matter of the body.
Vec3 slipOf(const SoftRow& row, std::span<const Displacement> moved);
// How an impulse along n moves from, to, the body and turns it: momentum, by that impulse.
std::array<Vec3, 4> sidesOf(const SoftRow& row);
// Displaces the ends and the body by an impulse on the soft side.
void giveTo(const SoftRow& row, const Vec3& impulse, std::span<Displacement> moved);

// Rows at the present poses, which start from the contacts' multipliers.
void prepareSoftRows(std::span<const SoftContact> contacts, std::span<const Pose> pose,
                     std::span<const JointMass> masses, std::vector<SoftRow>& rows);
void warmStart(std::span<SoftRow> rows, std::span<Displacement> moved);
void sweepPositions(std::span<SoftRow> rows, double push, std::span<Displacement> moved);
// Before the velocity sweeps of a substep: how far they are open.
void measure(std::span<SoftRow> rows, std::span<const Displacement> moved);
void sweepVelocities(std::span<SoftRow> rows, std::span<Displacement> moved);
void takeOver(std::span<const SoftRow> rows, std::span<SoftContact> contacts);

// The multipliers, for a substep of h, of contacts that were there before; both in the collider's
// order.
void keepSoft(std::span<const SoftContact> before, double h, std::span<SoftContact> now);

}  // namespace physics
