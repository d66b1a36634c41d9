// What a World tells about a step and about its constraints.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "physics/bodies/body.h"

namespace physics {

// How often a step did what only some scenes call for.
struct StepWork {
  std::int64_t broadPhase = 0;     // looks for pairs of bounds that overlap
  std::int64_t narrowPhase = 0;    // distances between two shapes
  std::int64_t contactVisits = 0;  // manifolds solved, over all sweeps
  std::int64_t frictionRows = 0;   // of these manifolds
  std::int64_t turns = 0;          // free turns of bodies that a torque can turn, over all substeps
  std::int64_t gyroscopic = 0;     // those of them with a gyroscopic torque
  std::int64_t moves = 0;          // free motions of bodies, over all substeps
  std::int64_t restSpeeds = 0;     // bodies asked whether they rest
  int madeAnew = 0;  // the step, because it met bodies asleep or of another number of substeps
};

// Bytes that an effect or kind holds; none where it is not listed.
struct EffectMemory {
  std::string effect;  // a scene's word
  std::size_t bytes = 0;
};

// Where an accuracy is asked for: how what steps by it did, all islands together.
struct AccuracyReport {
  int accepted = 0, rejected = 0;  // steps of single islands
  int order = 0;                   // the highest
  double least = 0;                // the shortest [s]
  double estimate = 0;             // of the error of this step, relative; the largest of an island
};
// What islands, or frames, tell together.
inline void add(const AccuracyReport& of, AccuracyReport& to) {
  to.accepted += of.accepted;
  to.rejected += of.rejected;
  to.order = std::max(to.order, of.order);
  to.least = to.least > 0 && of.least > 0 ? std::min(to.least, of.least) : to.least + of.least;
  to.estimate = std::max(to.estimate, of.estimate);
}

// What a step did, and what went wrong in it.
struct StepReport {
  int substeps = 0;
  int iterations = 0;  // sweeps in all
  std::int64_t constraintEvaluations = 0;
  // Second-order steppings: substeps of single bodies that were
  int restarts = 0;   // made without a past: at the start, and where velocities jumped
  int fallbacks = 0;  // made by bdf2 where the symmetric scheme was asked for
  int asleep = 0;     // bodies, at the end of the step
  StepWork work;
  AccuracyReport accuracy;
  struct NotFinite {
    int substep = 0;
    BodyId body = -1;
    std::string constraint;  // "ball_socket 3", or empty where the free motion already failed
  };
  std::optional<NotFinite> notFinite;  // the world was put back to the state before the step
};

// The errors of one kind of constraint, in the unit of its rows.
struct KindError {
  std::string kind;
  std::string unit;  // "m", "rad", or "1" for a volume's relative error
  double largest = 0;
  double sum = 0;  // of |c| over them all
  int count = 0;
  int worst = -1;  // index within the kind
};

// A contact point as a picture or a table wants it.
struct ContactReport {
  BodyId a, b;
  Vec3 point;    // world [m]
  Vec3 normal;   // world, from b to a
  double gap;    // m, negative: overlap
  Vec3 impulse;  // on a, over the last substep [N s]
};

struct JointReport {
  std::string kind;
  BodyId a, b;
  Vec3 pointA, pointB;        // world
  Vec3 axis;                  // world, zero where the kind has none
  double error;               // m or rad
  Vec3 axisB = Vec3::Zero();  // world: what `axis` is held against, in body b
  double cone = 0;            // rad: how far the axes may stand apart
};

// A tetrahedron whose volume is kept, (140),(141).
struct VolumeReport {
  std::array<BodyId, 4> bodies;
  std::array<Vec3, 4> gradient;  // dc/dx = 2 A [m^2], A the directed area of the opposite triangle
  double error;                  // |V/V0 - 1|
};

}  // namespace physics
