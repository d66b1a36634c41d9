// Numbers that are not finite: whose they are.
#include "physics/model/finite.h"

#include <cmath>

namespace physics {
namespace {

bool isFinite(const Model& model, BodyId i) {
  const Pose& pose = model.bodies.pose[i];
  const Velocity& velocity = model.bodies.velocity[i];
  return std::isfinite(pose.x.sum() + pose.q.coeffs().sum() + velocity.v.sum() + velocity.w.sum() +
                       model.loads[i].force.sum() + model.loads[i].torque.sum());
}

}  // namespace

void checkFinite(const Model& model, BodyId body, StepReport& report) {
  if (!report.notFinite && !isFinite(model, body)) report.notFinite = {report.substeps, body, ""};
}

void checkFinite(const Model& model, StepReport& report) {
  for (const BodyId i : model.bodies.active) checkFinite(model, i, report);
  for (const BodyId i : model.loaded) checkFinite(model, i, report);
}

void nameCulprit(StepReport& report, const char* kind, std::size_t index, BodyId body) {
  report.notFinite = {report.substeps, body, std::string(kind) + " " + std::to_string(index)};
}

}  // namespace physics
