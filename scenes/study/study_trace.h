// What a run of a study recorded, what it should have been, and how far apart they are.
#pragma once

#include <optional>
#include <vector>

#include "scenes/measure/sampler.h"
#include "scenes/study/study_quantity.h"

namespace scenes {

// The components of every body a quantity is about, sample by sample from 0. Empty where there is
// none at that sample.
using QuantitySamples = std::vector<std::vector<double>>;

struct StudyTrace {
  std::vector<QuantitySamples> quantities;  // in the order of the case
  int samples = 0;                          // that were reached
};

// The largest, in absolute value, over all samples.
struct StudyWorst {
  double residual = 0;       // of constraints in metres [m]
  double residualAngle = 0;  // of constraints in radians [rad]
  double overlap = 0;        // m
  double energyDrift = 0, momentumDrift = 0, angularMomentumDrift = 0;  // as the metrics say
};

class StudyTracer {
 public:
  StudyTracer(const StudyCase& study, const Simulation& simulation);
  void observe(const Simulation& simulation);  // every sample, from 0
  const StudyTrace& trace() const { return trace_; }
  const StudyWorst& worst() const { return worst_; }

 private:
  void observeWorst(const Sample& sample);

  const StudyCase& study_;
  Sampler sampler_;
  std::vector<std::vector<physics::BodyId>> bodies_;  // per quantity
  StudyTrace trace_;
  StudyWorst worst_;
};

// The truth of a case from its table and laws; what has neither is zero, or is `self` where that is
// given. One set of components stands for every body.
StudyTrace truthOf(const StudyCase& study, const StudyTrace* self);

struct StudyErrors {
  double error = 0;  // as the case reduces it
  double last = 0;   // at the last sample that is compared
  int compared = 0;  // samples
};
// `trace` must have reached every sample.
StudyErrors compare(const StudyCase& study, const StudyTrace& trace, const StudyTrace& truth);

// How far the case's table can be trusted, over the samples that are compared. None where nothing
// says so.
std::optional<double> tableAccuracy(const StudyCase& study);

}  // namespace scenes
