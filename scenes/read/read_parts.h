// shapes = [ ... ]: the parts of a body of several shapes.
#pragma once

#include "physics/bodies/compound.h"
#include "physics/make/matter.h"
#include "scenes/read/table_reader.h"
#include "scenes/view/palette.h"

namespace scenes {

struct ReadParts {
  physics::PrincipalCompound made;
  std::vector<std::optional<render::Color>> colors;  // by part
};

// The inertia of the whole as the file states it: its moments about a centre, along axes.
struct StatedInertia {
  double mass = 0;        // kg
  physics::Vec3 moments;  // kg m^2
  physics::Pose frame;    // the centre of mass and the principal axes, in the body's frame
};

// `matter`: of the body, whose density is that of parts which state none. `stated` counts in place
// of what the parts sum to.
ReadParts readParts(const Value& value, const Spot& spot, const physics::Matter& matter,
                    const std::optional<StatedInertia>& stated);

}  // namespace scenes
