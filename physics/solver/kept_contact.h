// A contact between two bodies as the small steps keep it from step to step: the manifold, and what
// it carried.
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "physics/base/workers.h"
#include "physics/bodies/body.h"
#include "physics/collision/collider.h"
#include "physics/constraints/contact.h"

namespace physics {

struct KeptContact {
  BodyId a = 0, b = 0;
  std::uint64_t key = 0;                 // as in ContactPair
  bool radial = false, carried = false;  // as in ContactPair
  int count = 0;
  Vec3 normal = Vec3::UnitY();  // body frame of b when carried, else world
  Friction friction;
  // The substep that the multipliers belong to, and the step that this is the last of [s].
  double step = 0, whole = 0;
  // Impulses times the substep, on a: along the normal, at the last one, and before that step on
  // the average of a step of the world's; of friction at the centre (world), and of its twist about
  // the normal.
  std::array<double, Manifold::kMaxPoints> lambda{}, before{};
  // Force [N] about which it gives way: that the points carried where the world began, that two
  // rows of an accuracy's step agreed on, or that bodies with joints, and those whose loads are
  // found at once, have come to rest on. It goes down with the load.
  std::array<double, Manifold::kMaxPoints> held{};
  Vec3 tangential = Vec3::Zero();
  double twist = 0;
  std::array<ContactPoint, Manifold::kMaxPoints> points;

  // Of the points of one of these, in all.
  static double sumOf(const std::array<double, Manifold::kMaxPoints>& loads) {
    return std::accumulate(loads.begin(), loads.end(), 0.0);
  }
  double stayed(int point) const { return std::min(lambda[point], before[point]); }  // in both
  bool isLoaded() const { return lambda != std::array<double, Manifold::kMaxPoints>{}; }
  bool isHeld() const { return held != std::array<double, Manifold::kMaxPoints>{}; }
};

// `contacts` become what the collider found, with the multipliers of the points that go on. Both
// are sorted by their key. `before` is scratch.
void keep(std::span<const Found> found, const Bodies& bodies, Workers& workers,
          std::vector<KeptContact>& contacts, std::vector<KeptContact>& before);

// A contact's surfaces are those of `found` from here on, which is of the same pair.
void renew(const Manifold& found, const Bodies& bodies, KeptContact& contact);

// The same as the sweeps' pair, for reports: multipliers belong to a substep of `step`.
ContactPair pairOf(const KeptContact& contact, double step);

Vec3 normalOf(const KeptContact& contact, std::span<const Pose> pose);
double leastGapOf(const KeptContact& contact, std::span<const Pose> pose);  // of its points [m]

}  // namespace physics
