// The factor of ropes, and of what else has one with little fill: what its matrix is made of.
#include <algorithm>
#include <type_traits>

#include "physics/base/inverse.h"
#include "physics/solver/deformable.h"

namespace physics {

using namespace swept;

bool Deformable::isOwn(BodyId body) const {
  return std::binary_search(bodies_.begin(), bodies_.end(), body);
}

int Deformable::placeOf(BodyId body) const {
  const auto found = std::lower_bound(solved_.begin(), solved_.end(), body);
  if (found == solved_.end() || *found != body) return -1;
  return static_cast<int>(found - solved_.begin());
}

void Deformable::takeContacts(std::span<SoftRow> rows, double push) {
  contacts_.clear();
  found_.clear();
  push_ = push;
  for (SoftRow& row : rows) {
    if (!(isOwn(row.from) || isOwn(row.to)) || !(row.inverse > 0)) continue;
    row.owned = true;
    row.held = !(row.lambda > 0);
    row.lambda = row.next = 0;
    row.friction.setZero();
    contacts_.push_back(&row);
    found_.push_back({row.from, row.to, row.body});
  }
}

void Deformable::takeLaid() {
  laid_ = found_;
  solved_ = bodies_;
  for (const SoftRow* row : contacts_) {
    if (row->inverseMass > 0) solved_.push_back(row->body);
  }
  std::sort(solved_.begin(), solved_.end());
  solved_.erase(std::unique(solved_.begin(), solved_.end()), solved_.end());
}

void Deformable::takeMasses(std::span<const JointMass> masses) {
  const std::size_t count = solved_.size();
  const bool isNew = unknown_.empty();
  unknown_.resize(count);
  turns_.resize(count);
  inertia_.resize(count);
  mass_.resize(count);
  if (isNew) unknowns_ = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const JointMass& mass = masses[solved_[k]];
    mass_[k] = 1 / mass.inverse;
    if (isNew) {
      turns_[k] = !mass.inertia.isZero(0);
      unknown_[k] = unknowns_;
      unknowns_ += turns_[k] ? 6 : 3;
    }
    if (turns_[k]) inertia_[k] = inverseOrNan(mass.inertia);
  }
  factor_->stale = true;
}

// What a row gives way by besides alpha.
double Deformable::leastOf(const SweptItem& swept) const {
  return (givesInLine(swept) ? gives_ : kRedundancy) * swept.own;
}

// entry(row, column, value) of the lower triangle, always the same ones in the same order.
template <class F>
void Deformable::emit(bool positions, F&& entry) {
  for (std::size_t k = 0; k < solved_.size(); ++k) {
    for (int i = 0; i < 3; ++i) {
      entry(unknown_[k] + i, unknown_[k] + i, mass_[k]);
      if (!turns_[k]) continue;
      for (int j = 0; j <= i; ++j)
        entry(unknown_[k] + 3 + i, unknown_[k] + 3 + j, inertia_[k](i, j));
    }
  }
  // Between two points, on what they move by against each other.
  const auto pull = [&](BodyId a, BodyId b, const Mat3& stiffness) {
    const int pa = placeOf(a), pb = placeOf(b);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (pa >= 0 && j <= i) entry(unknown_[pa] + i, unknown_[pa] + j, stiffness(i, j));
        if (pb >= 0 && j <= i) entry(unknown_[pb] + i, unknown_[pb] + j, stiffness(i, j));
        if (pa >= 0 && pb >= 0) {
          entry(unknown_[std::max(pa, pb)] + i, unknown_[std::min(pa, pb)] + j, -stiffness(i, j));
        }
      }
    }
  };
  int at = unknowns_;
  forEachRow(rows_, [&]<int kRows>(SweptRow<kRows>& swept) {
    const bool free = swept.swept && !swept.held;
    if constexpr (kRows == 1) {
      const double pulls = positions && swept.active ? -swept.pulled[0] : 0;
      const double length = swept.length / static_cast<double>(swept.bodies.size() - 1);
      Vec3 along = Vec3::Zero();
      for (std::size_t p = 1; swept.isOfPieces() && p < swept.bodies.size(); ++p) {
        if (swept.active) along += swept.linear[p - 1].j.transpose();
        pull(swept.bodies[p - 1], swept.bodies[p], turningStiffness(along, pulls, length));
      }
    }
    for (std::size_t b = 0; b < swept.bodies.size(); ++b) {
      const int place = placeOf(swept.bodies[b]);
      if (place < 0) continue;
      for (int r = 0; r < kRows; ++r) {
        for (int j = 0; j < 3; ++j) {
          if (swept.moves) {
            entry(at + r, unknown_[place] + j, free ? swept.linear[b].j(r, j) : 0);
          }
          if (swept.turns) {
            if (turns_[place]) {
              entry(at + r, unknown_[place] + 3 + j, free ? swept.angular[b].j(r, j) : 0);
            }
          }
        }
      }
    }
    for (int r = 0; r < kRows; ++r) {
      for (int j = 0; j <= r; ++j) {
        const double gives = free ? swept.alpha(r, j) : 0;
        const double least = free ? leastOf(swept) : 1;
        entry(at + r, at + j, -gives - (r == j ? least : 0));
      }
    }
    at += kRows;
  });
  for (const SoftRow* row : contacts_) {
    for (const bool second : {false, true}) {
      const int place = placeOf(second ? row->to : row->from);
      if (place < 0) continue;
      const double share = row->held ? 0 : second ? row->along : 1 - row->along;
      for (int j = 0; j < 3; ++j) entry(at, unknown_[place] + j, share * row->n[j]);
    }
    const Vec3 lever = row->arm.cross(row->n);
    const int place = placeOf(row->body);
    for (int j = 0; place >= 0 && j < 3; ++j) {
      entry(at, unknown_[place] + j, row->held ? 0 : -row->n[j]);
      if (turns_[place]) entry(at, unknown_[place] + 3 + j, row->held ? 0 : -lever[j]);
    }
    entry(at, at, row->held ? -1 : -kRedundancy / row->inverse);
    ++at;
  }
}

void Deformable::factorize(bool positions) {
  MeshFactor& f = *factor_;
  f.stale = false;
  if (!f.factor.isLaidOut()) {
    f.entries.clear();
    emit(positions, [&](int row, int column, double) { f.entries.push_back({row, column}); });
    f.factor.layOut(f.entries);
    int rows = 0, own = 0;
    forEachRow(rows_, [&]<int kRows>(const SweptRow<kRows>& swept) {
      if (!swept.isForce) rows += kRows;
    });
    for (std::size_t k = 0; k < solved_.size(); ++k) {
      if (isOwn(solved_[k])) own += turns_[k] ? 6 : 3;
    }
    repeats_ = rows > own - 6;
    f.right.resize(f.factor.size());
  }
  f.factor.begin();
  emit(positions, [&](int, int, double value) { f.factor.give(value); });
  f.factor.factorize();
}

}  // namespace physics
