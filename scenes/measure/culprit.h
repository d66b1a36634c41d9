// Where in a scene a metric has its value: the bodies and the constraint to look at.
#pragma once

#include <string>

#include "scenes/measure/metrics.h"

namespace scenes {

struct Culprit {
  std::string bodies;      // "chain.18, chain.end"; empty: none stands out
  std::string constraint;  // "ball_socket 19", "contact"; empty: none
};

// Of a metric of one body: that body. Of energy, momentum and speed: the body that moves most.
Culprit findCulprit(const Sample& sample, const Metric& metric, physics::BodyId body = -1);

}  // namespace scenes
