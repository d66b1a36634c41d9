// Vectors of a body, and distances between values.
#include "scenes/study/study_quantity.h"

#include <algorithm>
#include <cmath>

#include "scenes/measure/series.h"

namespace scenes {
namespace {

using physics::Pose;
using physics::Velocity;

void put(const physics::Vec3& v, double* out) { std::copy(v.data(), v.data() + 3, out); }

constexpr VectorMetric kVectors[] = {
    {"position", "m", 3, [](const Pose& pose, const Velocity&, double* out) { put(pose.x, out); }},
    {"velocity", "m/s", 3, [](const Pose&, const Velocity& v, double* out) { put(v.v, out); }},
    {"angular_velocity", "rad/s", 3,
     [](const Pose&, const Velocity& v, double* out) { put(v.w, out); }},
    {"body_angular_velocity", "rad/s", 3,
     [](const Pose& pose, const Velocity& v, double* out) { put(pose.q.conjugate() * v.w, out); }},
    {"orientation", "rad", 4,
     [](const Pose& pose, const Velocity&, double* out) {
       out[0] = pose.q.w();
       put(pose.q.vec(), out + 1);
     }},
};

// atan2 of the relative turn: exact for small angles, where acos of a product would be noise.
double angleBetween(const double* a, const double* b) {
  const physics::Quat p(a[0], a[1], a[2], a[3]), q(b[0], b[1], b[2], b[3]);
  const physics::Quat turn = p * q.conjugate();
  return 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

}  // namespace

const VectorMetric* findVectorMetric(const std::string& name) {
  for (const VectorMetric& vector : kVectors) {
    if (name == vector.name) return &vector;
  }
  return nullptr;
}

std::vector<std::string> vectorMetricNames() {
  std::vector<std::string> names;
  for (const VectorMetric& vector : kVectors) names.emplace_back(vector.name);
  return names;
}

bool isOrientation(const StudyQuantity& quantity) { return quantity.metric == "orientation"; }

int componentsOf(const StudyQuantity& quantity) {
  const VectorMetric* vector = findVectorMetric(quantity.metric);
  return vector == nullptr ? 1 : vector->components;
}

std::string unitOf(const StudyQuantity& quantity) {
  const VectorMetric* vector = findVectorMetric(quantity.metric);
  return vector == nullptr ? unitOf(quantity.metric) : vector->unit;
}

double distance(const StudyQuantity& quantity, const double* value, const double* truth) {
  if (isOrientation(quantity)) return angleBetween(value, truth);
  double square = 0;
  for (int i = 0; i < componentsOf(quantity); ++i) {
    square += (value[i] - truth[i]) * (value[i] - truth[i]);
  }
  return std::sqrt(square);
}

}  // namespace scenes
