// What the quantities of a study measure: metrics of scenes/metrics, and vectors of a body.
#pragma once

#include "scenes/simulation.h"
#include "scenes/study/study_case.h"

namespace scenes {

struct VectorMetric {
  const char* name;
  const char* unit;
  int components;
  void (*read)(const physics::Pose& pose, const physics::Velocity& velocity, double* out);
};
const VectorMetric* findVectorMetric(const std::string& name);  // null: none
std::vector<std::string> vectorMetricNames();

bool isOrientation(const StudyQuantity& quantity);
int componentsOf(const StudyQuantity& quantity);
std::string unitOf(const StudyQuantity& quantity);

// How far `value` is from `truth`, both of as many components: the norm of the difference, or the
// angle between two orientations [rad].
double distance(const StudyQuantity& quantity, const double* value, const double* truth);

}  // namespace scenes
