// What is measured, as it is kept from frame to frame.
#pragma once

#include "physics/base/archive.h"
#include "scenes/simulation.h"

namespace physics {

inline void archive(Archive& a, KindError& error) {
  auto& [kind, unit, largest, sum, count, worst] = error;
  a(kind, unit, largest, sum, count, worst);
}

inline void archive(Archive& a, AccuracyReport& report) {
  auto& [accepted, rejected, order, least, estimate] = report;
  a(accepted, rejected, order, least, estimate);
}

}  // namespace physics

namespace scenes {

inline void archive(physics::Archive& a, FrameMetrics& metrics) {
  auto& [frame, time, kinetic, potential, total, linearMomentum, angularMomentum, errors, overlap,
         maxSpeed, contacts, iterations, asleep, restarts, fallbacks, accuracy] = metrics;
  a(frame, time, kinetic, potential, total, linearMomentum, angularMomentum, errors, overlap,
    maxSpeed, contacts, iterations, asleep, restarts, fallbacks, accuracy);
}

inline void archive(physics::Archive& a, Checker::Failure& failure) {
  auto& [frame, value, bodies, constraint] = failure;
  a(frame, value, bodies, constraint);
}

}  // namespace scenes
