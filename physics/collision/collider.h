// Shapes in, contact manifolds out. The collider finds pairs that can touch during a step and keeps
// what it found for as long as the bodies stay within the bounds it was found with.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "physics/base/types.h"
#include "physics/bodies/shape.h"

namespace physics {

// One point of a manifold. The surfaces are cores (a sphere's centre, a capsule's segment, a box's
// face) plus a radius along the normal; with R_a, R_b the present rotations and n the present
// normal,
//   p_a = x_a + R_a coreA - radiusA n,   p_b = x_b + R_b coreB + radiusB n,   gap c = (p_a - p_b) .
//   n   (91)
// so that a rolling sphere keeps its gap exactly while it turns.
struct ContactPoint {
  Vec3 coreA = Vec3::Zero();  // body frame of a
  Vec3 coreB = Vec3::Zero();  // body frame of b
  double radiusA = 0;         // m
  double radiusB = 0;         // m
  std::uint32_t feature = 0;  // same value = same pair of features, from step to step
};

// At most four points between two bodies, a < b not required but (a, b) stable for a pair of shapes
// over its life. Bodies of several parts have a manifold for each pair of parts that meet.
struct Manifold {
  static constexpr int kMaxPoints = 4;
  BodyId a = 0, b = 0;
  bool radial = false;     // the normal joins the centres of the two bodies: sphere on sphere
  bool carried = false;    // the normal is that of a face of b, and turns with it
  std::uint64_t pair = 0;  // of which two shapes, the same over their life; they are sorted by it
  Vec3 normal = Vec3::UnitY();  // body frame of b, unit, from b towards a
  int count = 0;
  std::array<ContactPoint, kMaxPoints> points;
};

// A manifold where the collider keeps it. Not new: as the last look told it.
struct Found {
  const Manifold* manifold = nullptr;
  bool isNew = true;
};

class Archive;
class Workers;
class Collider {
 public:
  Collider();
  ~Collider();
  Collider(Collider&&) noexcept;
  Collider& operator=(Collider&&) noexcept;

  // `movable` false: nothing pushes it; two such bodies are never a pair. Ids are added in
  // increasing order. The parts of a compound are looked at one by one.
  void add(BodyId body, const Shape& shape, bool movable);
  void ignore(BodyId a, BodyId b);  // this pair never touches (jointed neighbours)
  std::span<const std::pair<BodyId, BodyId>> ignored() const;  // sorted, first < second

  // Finds all manifolds whose gap can close while bodies move from `start` to `end` (poses indexed
  // by BodyId, the same length). A point is reported when its gap at `start` is at most `margin`
  // [m] plus what the two bodies approach each other by. Where a body moves by more than it is
  // thick, the manifold is that of the first touch along the straight sweep (normal and points
  // taken there). The result is sorted by (a, its part, b, its part), deterministic, and valid
  // until the next call. No allocation once the scene has settled.
  std::span<const Manifold> find(std::span<const Pose> start, std::span<const Pose> end,
                                 double margin);

  // The same by all `workers`, where the collider keeps it: what is found of a pair depends on no
  // other. `push`, by BodyId or empty: further than to `end`. What bodies may meet by that is told
  // as if they approached each other by so much more.
  std::span<const Found> look(std::span<const Pose> start, std::span<const Pose> end, double margin,
                              std::span<const double> push, Workers& workers);
  std::span<const Found> found() const;  // by the last look

  // The manifold of a pair that a look found, at these poses of its two bodies: the points whose
  // gap is at most `near` [m], where corners may turn by `turn` [m] until the next look. False: one
  // is a mesh, which is not looked at so.
  bool lookAt(std::uint64_t pair, const Pose& poseA, const Pose& poseB, double near, double turn,
              Manifold& manifold) const;

  // True when one of `bodies`, moving from `start` to `end`, leaves the bounds that the last find()
  // looked in: contacts may be missing, call find() again.
  bool outdated(std::span<const Pose> start, std::span<const Pose> end,
                std::span<const BodyId> bodies) const;

  // Bodies that stand still at these poses until they are woken: no work goes into them, and two of
  // them are not reported. In increasing order.
  void rest(std::span<const BodyId> bodies, std::span<const Pose> poses);
  void wake(std::span<const BodyId> bodies);

  // False: every pair is ignored, or nothing in it moves; find() has nothing to look for.
  bool canTouch() const;
  void forgetFound();  // manifolds of earlier looks: of no point it is known that it was kept
  bool hasShapes() const;
  void forgetShapes();  // but not which pairs are ignored

  // Signed distance [m] (negative: depth) of two bodies at these poses; +infinity for a pair
  // without shapes. For measures and tests, not for the step.
  double distance(BodyId a, const Pose& poseA, BodyId b, const Pose& poseB) const;
  // Smallest full extent of its parts; +infinity: a plane, or none.
  double thickness(BodyId body) const;

  // Work done so far, for measures: narrow-phase evaluations and pairs now watched.
  struct Counts {
    std::int64_t narrowPhaseCalls = 0;
    std::int64_t broadPhaseCalls = 0;
    int pairs = 0;
  };
  Counts counts() const;
  std::size_t bytes() const;  // held now
  void archive(Archive& a);   // of the same shapes, added and ignored alike

 private:
  struct Impl;
  Impl& held();
  std::unique_ptr<Impl> impl_;  // absent until something is added
};

}  // namespace physics
