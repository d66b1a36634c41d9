// The narrow phase: two solids at a relative pose in, one manifold out. Pure functions.
#pragma once

#include "physics/collision/collider.h"
#include "physics/collision/solid.h"

namespace physics::collision {

// a.kind must not be later than b.kind. When the solids are within `reach`, fills `out` with the
// points whose gap is at most `keep` and returns the distance (negative: depth along the normal);
// otherwise out.count is 0 and the answer is a lower bound of the distance, above `reach`: they are
// that far apart along out.normal. It is the best bound of the directions tried unless above
// `keep`. `turn` [m]: what corners may turn by before the two are looked at again. Faces that are
// nearly parallel meet with all of their corners then, though two of their edges are nearer now.
// Where more points touch than a manifold has, those that `out` has from the last look stay, and
// the deepest at `ends` is one of them.
struct Ends;
double touch(const Solid& a, const Solid& b, const Relative& pose, double reach, double keep,
             double turn, Manifold& out, const Ends* ends = nullptr);

// Whether that decides which of the two features touch.
bool turnsFar(const Solid& a, const Solid& b, double turn);

// A lower bound of the distance, along n (from b to a, b's frame), quickly: not less than a third
// of it, and below zero only when they overlap.
struct Apart {
  double distance = 0;
  Vec3 n = Vec3::UnitY();
};
Apart apart(const Solid& a, const Solid& b, const Relative& pose);

// The point where the solids would part when moved apart along n (from b to a, b's frame) from a
// separation of their cores that is `separation`; where they do not part, the point of a that is
// deepest along -n.
struct Contacts;
void touchParting(const Solid& a, const Solid& b, const Relative& pose, const Vec3& n,
                  double separation, Contacts& contacts);

// Signed distance. Exact for separated solids, and for overlapping ones but for cylinders, where it
// is the depth along the best direction found. b may be of an earlier kind than a.
double signedDistance(const Solid& a, const Solid& b, const Relative& pose);

}  // namespace physics::collision
