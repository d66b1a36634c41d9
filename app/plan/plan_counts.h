// Counts and bytes of a plan, from the World itself.
#pragma once

#include "app/plan/plan.h"

namespace app {

// Runs the plan's steps once more. Fills in pairs and bytes.
void countWork(const scenes::Scene& scene, Plan& plan);

}  // namespace app
