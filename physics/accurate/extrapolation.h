// An island to a given time, as accurately as asked: steps H by extrapolation of the symmetric
// step, whose error has even powers of h only, so that T_kk of tableau.h, in 1, 2, ... k steps, is
// of order 2k. What T_kk and T_k,k-1 differ by is the estimate of the error; H and k follow from it
// at the least work for the time. Where T_11 alone is right by far, that is all that is made, and
// how much a step bends tells its error: as much as it was of that when T_22 was last made. Hairer,
// Norsett, Wanner, Solving Ordinary Differential Equations I, II.9.
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
  void archive(Archive& a);

 private:
  bool run(int n, double from, double whole, const Surroundings& world, const TrialPoses& trial);
  bool runAlone(double from, double whole, double allowed, const Surroundings& world,
                const TrialPoses& trial, double& error);
  double bendOf(double whole, std::span<const Velocity> end) const;
  void takeBest();
  void note(double whole, double error);

  SymmetricStep step_;
  Tableau tableau_;
  IslandState state_, row_;
  StepChoice choice_{2, 2, Tableau::kMostRows};
  // The last step's velocities, from start to end, how long it took [s], 0: not known, and what it
  // bent by; what T_11 errs by of that, 0: not known; and how often that was trusted since.
  std::vector<Velocity> before_, now_;
  double lasted_ = 0, errs_ = 0, bent_ = 0;
  int trusted_ = 0;
  double tolerance_ = 0;  // that joints close to
  int stepsOfRow_ = 1;    // of the first; the others have so many times more
};

}  // namespace physics
