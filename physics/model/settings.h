// How a World steps: time, method and the effects that are on.
#pragma once

#include <optional>

#include "physics/bodies/body.h"

namespace physics {

enum class Method {
  kNonlinearGaussSeidel,  // (52)
  kDirect,                // (42) for joints, Gauss-Seidel for what has bounds
  kLinearGaussSeidel,     // (51), for comparison
  kXpbd,                  // from here on rivals, see rivals/rival.h
  kSequentialImpulses,
  kPenalty,  // implicit steps
  kPenaltyExplicit,
  kSmallSteps,  // small_steps/small_steps.h
};
enum class Stepping {
  kPaper,   // backward Euler
  kStatic,  // no motion: every step solves from rest and ends at rest, so that with one substep and
            // one iteration the steps are the solver's iterations
  kBdf2,    // second order, stable at any stiffness; the end of a step decides the directions
  kSymmetric,  // RATTLE: second order, keeps energy where the step resolves the motion
};
enum class Regularisation {
  kCompliance,  // in mu and as alpha lambda (56): gives way
  kDamping,     // in mu alone: slower, and exact where an exact solution exists. NOTES 3.5
};

struct ContactSettings {
  Friction friction;
  double restitution = 0;  // 0..1
  // m/s: overlap that exists is resolved no faster, than what a fall of 5 cm ends with; not (52)'s.
  double maxSeparationSpeed = 1;
  double margin = 0.02;  // m: gaps below are watched at rest; a fall takes four frames for it
};

// Islands that have come to rest are left alone until something touches them. effects/sleep.h
struct SleepSettings {
  double speed = 1e-3;  // at rest: all of an island slower than this [m/s]
  double time = 0.5;    // for so long [s]: a quarter of a swing of a pendulum of 1 m
};

struct Settings {
  double dt = 1.0 / 60;            // one step() [s]: a frame of a usual display
  std::optional<double> accuracy;  // of the default method: relative to the size of what moves;
                                   // absent: as fast as it is. accurate/extrapolation.h
  // Absent: four, but of the default method each island takes what it asks for; else no fewer.
  std::optional<int> substeps;
  int substepCount() const { return substeps.value_or(4); }
  bool choosesSubsteps() const { return takesSmallSteps() && !substeps; }
  int iterations = 1;               // sweeps over all constraints per substep, N of Algorithm 1
  std::optional<double> tolerance;  // more of them, while one still moves a body by more [m]
  int maxIterations = 40;           // and no more than these
  Method method = Method::kSmallSteps;
  Stepping stepping = Stepping::kPaper;
  // By another stepping the default is the paper's method.
  bool takesSmallSteps() const {
    return method == Method::kSmallSteps && stepping == Stepping::kPaper;
  }
  double relaxation = 1;      // xi (53)
  double regularisation = 0;  // epsilon, alpha = epsilon * J M^-1 J^T (54)
  Regularisation regularisationForm = Regularisation::kCompliance;
  bool spinInertia = false;                  // M~ of (36),(65) instead of M, where |w| h <= 0.2
  bool refreshInertia = true;                // inertia follows the turn of every iteration (4.1)
  bool warmStartJoints = false;              // of earlier versions: lambda = 0 in Algorithm 1
  std::optional<double> maxCorrectionSpeed;  // small steps: a joint's error at X^t is taken back no
                                             // faster [m/s, rad/s]; absent: in one substep
  std::optional<double> penaltyStiffness;    // kappa of the penalty methods; absent: their own
  std::optional<Vec3> gravity;               // m/s^2; absent: none
  std::optional<ContactSettings> contact;    // absent: nothing touches
  std::optional<SleepSettings> sleep;        // absent: nothing sleeps
  bool localSubsteps = false;    // each island as many as it needs, `substeps` at the most
  double localTolerance = 1e-4;  // error of a joint, or overlap, that asks for more [m or rad]
  bool leavesOut = true;         // what cannot matter is not computed; false: for comparison
};

}  // namespace physics
