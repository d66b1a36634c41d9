// Compounds: several shapes as one rigid body, their masses summed.
#pragma once

#include <span>
#include <vector>

#include "physics/bodies/shape.h"

namespace physics {

struct Part {
  Shape shape;  // with a volume: neither a point, ground nor another compound
  Pose pose;    // of the shape's frame in the body's
};

struct Parts {
  std::vector<Part> list;
  double volume = 0;                   // m^3, the sum: where parts overlap it counts twice
  Vec3 inertiaPerMass = Vec3::Zero();  // principal [m^2]
};

// A part where its maker sees it, with its mass [kg].
struct PartDef {
  Shape shape;
  Pose pose;
  double mass = 1;
};

// The parts moved so that their common centre of mass is the origin and the principal axes are the
// frame's; `toParts` takes them back to where they were. Axes stay as they are when they are
// principal already. Throws std::invalid_argument for no parts, a mass that is not positive, or a
// part without a volume.
struct PrincipalCompound {
  Compound compound;
  Pose toParts;
  double mass = 0;  // kg
};
PrincipalCompound makeCompound(std::span<const PartDef> parts);

// The same about a centre of mass, axes and moments that are known otherwise: `frame` is that of
// the centre of mass and the principal axes, where the parts are.
PrincipalCompound makeCompound(std::span<const PartDef> parts, const Pose& frame,
                               const Vec3& inertiaPerMass);

// A pose in another's frame, seen from where the other is.
inline Pose placed(const Pose& frame, const Pose& inside) {
  return {frame.x + frame.q * inside.x, frame.q * inside.q};
}

}  // namespace physics
