// Contacts of points and links as rows.
#include "physics/solver/soft_rows.h"

#include <algorithm>
#include <utility>

#include "physics/base/inverse.h"
#include "physics/constraints/friction.h"

namespace physics {

Vec3 slipOf(const SoftRow& row, std::span<const Displacement> moved) {
  const Displacement& b = moved[row.body];
  return (1 - row.along) * moved[row.from].u + row.along * moved[row.to].u - b.u -
         b.theta.cross(row.arm);
}

std::array<Vec3, 4> sidesOf(const SoftRow& row) {
  if (row.from == row.to) return {row.n, Vec3::Zero(), -row.n, -row.arm.cross(row.n)};
  return {(1 - row.along) * row.n, row.along * row.n, -row.n, -row.arm.cross(row.n)};
}

void giveTo(const SoftRow& row, const Vec3& impulse, std::span<Displacement> moved) {
  moved[row.from].u += (row.first * (1 - row.along)) * impulse;
  moved[row.to].u += (row.second * row.along) * impulse;
  moved[row.body].u -= row.inverseMass * impulse;
  moved[row.body].theta -= row.inertia * row.arm.cross(impulse);
}

namespace {

void rub(SoftRow& row, std::span<Displacement> moved) {
  const Eigen::Vector2d wanted =
      row.friction - row.tangentInverse * (row.tangents.transpose() * slipOf(row, moved));
  const Eigen::Vector2d total = heldShare(row.coefficients, wanted.norm(), row.lambda) * wanted;
  giveTo(row, row.tangents * (total - row.friction), moved);
  row.friction = total;
}

}  // namespace

void prepareSoftRows(std::span<const SoftContact> contacts, std::span<const Pose> pose,
                     std::span<const JointMass> masses, std::vector<SoftRow>& rows) {
  rows.clear();
  for (const SoftContact& c : contacts) {
    SoftRow& row = rows.emplace_back();
    row.from = c.from;
    row.to = c.to;
    row.body = c.body;
    row.along = c.along;
    row.first = masses[c.from].inverse;
    row.second = masses[c.to].inverse;
    row.inverseMass = masses[c.body].inverse;
    row.inertia = masses[c.body].inertia;
    row.n = pose[c.body].q * c.normal;
    row.gap = gapOf(c, pose);
    row.arm = pointOf(c, pose) - c.radius * row.n - pose[c.body].x;
    row.coefficients = c.friction;
    const Vec3 lever = row.arm.cross(row.n);
    const double t = row.along;
    const double link = std::max(row.first * (1 - t) * (1 - t) + row.second * t * t,
                                 kLeastShare * (row.first + row.second));
    const double a = link + row.inverseMass + lever.dot(row.inertia * lever);
    row.inverse = a > 1e-300 ? 1 / a : 0;  // else it moves nothing
    row.tangents.col(0) = row.n.unitOrthogonal();
    row.tangents.col(1) = row.n.cross(row.tangents.col(0));
    Eigen::Matrix<double, 3, 2> levers;
    for (int k = 0; k < 2; ++k) levers.col(k) = row.arm.cross(row.tangents.col(k));
    const Eigen::Matrix2d resistance = (link + row.inverseMass) * Eigen::Matrix2d::Identity() +
                                       levers.transpose() * row.inertia * levers;
    row.tangentInverse = Eigen::Matrix2d::Zero();
    if (row.inverse > 0) row.tangentInverse = inverseOrNan(resistance);
    row.lambda = c.normalTotal;
    row.friction = row.tangents.transpose() * c.frictionTotal;
  }
}

void warmStart(std::span<SoftRow> rows, std::span<Displacement> moved) {
  for (const SoftRow& row : rows) {
    if (row.owned || !(row.lambda > 0)) continue;
    giveTo(row, row.lambda * row.n + row.tangents * row.friction, moved);
  }
}

void sweepPositions(std::span<SoftRow> rows, double push, std::span<Displacement> moved) {
  for (SoftRow& row : rows) {
    if (row.owned) continue;
    const double c = row.gap + row.n.dot(slipOf(row, moved)) - std::min(row.gap + push, 0.0);
    const double total = std::max(row.lambda - row.inverse * c, 0.0);
    giveTo(row, (total - row.lambda) * row.n, moved);
    row.lambda = total;
  }
}

void measure(std::span<SoftRow> rows, std::span<const Displacement> moved) {
  for (SoftRow& row : rows) row.open = std::max(row.gap + row.n.dot(slipOf(row, moved)), 0.0);
}

void sweepVelocities(std::span<SoftRow> rows, std::span<Displacement> moved) {
  for (SoftRow& row : rows) {
    if (!row.owned) {
      const double c = row.open + row.n.dot(slipOf(row, moved));
      const double total = std::max(row.lambda - row.inverse * c, 0.0);
      giveTo(row, (total - row.lambda) * row.n, moved);
      row.lambda = total;
    }
    if (row.lambda > 0 || !row.friction.isZero(0)) rub(row, moved);
  }
}

void takeOver(std::span<const SoftRow> rows, std::span<SoftContact> contacts) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    contacts[k].normalTotal = rows[k].lambda;
    contacts[k].frictionTotal = rows[k].tangents * rows[k].friction;
  }
}

void keepSoft(std::span<const SoftContact> before, double h, std::span<SoftContact> now) {
  const auto key = [](const SoftContact& c) { return std::pair(c.element, c.body); };
  std::size_t old = 0;
  for (SoftContact& contact : now) {
    contact.step = h;
    while (old < before.size() && key(before[old]) < key(contact)) ++old;
    if (old == before.size()) return;
    if (key(before[old]) != key(contact)) continue;
    const double ratio = before[old].step > 0 ? (h / before[old].step) * (h / before[old].step) : 0;
    contact.normalTotal = ratio * before[old].normalTotal;
    contact.frictionTotal = ratio * before[old].frictionTotal;
    ++old;
  }
}

}  // namespace physics
