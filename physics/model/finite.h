// Who is named where numbers stop being finite.
#pragma once

#include "physics/model/model.h"
#include "physics/model/report.h"

namespace physics {

// Names the first body whose pose, velocity or load is not finite, one that moves before any other.
void checkFinite(const Model& model, StepReport& report);
void checkFinite(const Model& model, BodyId body, StepReport& report);

// Tells which constraint gave a number that is not finite.
void nameCulprit(StepReport& report, const char* kind, std::size_t index, BodyId body);

}  // namespace physics
