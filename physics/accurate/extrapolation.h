// An island to a given time, as accurately as asked: steps H by extrapolation of the symmetric
// step, whose error has even powers of h only, so that T_kk of tableau.h, in 1, 2, ... k steps (or
// in m, m + 1, ...: lane_rows.h), is of order 2k. What T_kk and T_k,k-1 differ by is the estimate
// of the error; H and k follow from it at the least work for the time. Hairer, Norsett, Wanner,
// Solving Ordinary Differential Equations I, II.9.
#pragma once

#include "physics/accurate/step_choice.h"
#include "physics/accurate/symmetric_step.h"
#include "physics/accurate/tableau.h"
#include "physics/base/archive.h"
#include "physics/model/report.h"

namespace physics {

class Extrapolation {
 public:
  explicit Extrapolation(SymmetricStep step);

  const SymmetricStep& step() const { return step_; }
  // From `state` by `time`, every point of it right to `accuracy` of the island's size. False: out
  // of reach; `state` is as before.
  bool advance(IslandState& state, double time, double accuracy, const Surroundings& world,
               const TrialPoses& trial, AccuracyReport& report);
  // The same with a given order 2k and steps.
  bool advanceBy(IslandState& state, double time, int columns, int steps, const Surroundings& world,
                 const TrialPoses& trial);
  void archive(Archive& a) { a(step_, choice_); }

 private:
  bool run(int n, double from, double whole, const Surroundings& world, const TrialPoses& trial);
  bool fill(int first, int columns, double from, double whole, const Surroundings& world,
            const TrialPoses& trial);
  bool takeBest(const Surroundings& world, const TrialPoses& trial);

  SymmetricStep step_;
  Tableau tableau_;
  IslandState state_, row_;
  StepChoice choice_;
  double error_ = 0, coarser_ = 0;  // of the tableau, and of one column less
  // s: what a speed is off by counts as a way for as long as the island takes for its size, a frame
  // at least, and no longer than errors add up; where a damper takes it, within the step.
  double lasting_ = 0;
  double tolerance_ = 0;  // that joints close to
  int stepsOfRow_ = 1;    // of the first; the others have so many times more
};

}  // namespace physics
