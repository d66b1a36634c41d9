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

// `matter`: of the body, whose density is that of parts which state none.
ReadParts readParts(const Value& value, const Spot& spot, const physics::Matter& matter);

}  // namespace scenes
