// What a caller fills in to add a body, and what the step runs on.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "physics/base/types.h"
#include "physics/bodies/shape.h"

namespace physics {

enum class Motion {
  kDynamic,
  kStatic,     // never moves
  kKinematic,  // moves with its velocities, whatever pushes it
};

struct Friction {
  double staticCoefficient = 0.5;   // nu_s of (101)
  double dynamicCoefficient = 0.5;  // nu_d <= nu_s
};

struct BodyDef {
  Shape shape = PointShape{};
  double mass = 1;  // kg, > 0 where the body is dynamic
  std::optional<Vec3>
      inertia;  // principal moments, body frame [kg m^2]; absent: the shape's at this mass
  Pose pose;
  Velocity velocity;
  Motion motion = Motion::kDynamic;
  std::optional<Friction> friction;   // absent: the World's
  std::optional<double> restitution;  // 0..1, absent: the World's
  int substeps = 1;                   // at least, of its island, with local substeps
};

// The inverse mass and the inverse inertia in the world frame; zeros where nothing moves.
struct InverseMass {
  double m = 0;                 // 1/kg
  Mat3 inertia = Mat3::Zero();  // 1/(kg m^2), at the pose of the last refresh
};

// A displacement of one body.
struct DeltaX {
  Vec3 dx = Vec3::Zero();      // m
  Vec3 dtheta = Vec3::Zero();  // rad, world frame
};

// How a body makes a substep. motion/second_order.h
enum class Scheme : std::uint8_t { kPaper, kBdf2, kSymmetric };

// The substep before this one, as `bdf2` needs it.
struct History {
  Vec3 dx = Vec3::Zero(), dtheta = Vec3::Zero();  // X^{t-1} -> X^t
  Vec3 velocity = Vec3::Zero();                   // v^{t-1} [m/s]
  Vec3 angularMomentum = Vec3::Zero();            // L^{t-1} about the centre, world [kg m^2/s]
  bool smooth = false;                            // no velocity jumped in it
};

// What bodies carry for the second-order steppings; empty where all step by the paper's scheme.
struct SecondOrder {
  std::vector<Scheme> scheme;
  std::vector<double> step;  // the h of backward Euler that the body's substep amounts to [s]
  std::vector<History> history;
  std::vector<Pose> origin;        // X^t; Bodies::start is where backward Euler would have started
  std::vector<Pose> before;        // X^{t-1} where a body steps by bdf2, else `origin`
  std::vector<Pose> middle;        // scratch of the symmetric scheme's forces
  std::vector<Velocity> velocity;  // v^t
  std::vector<Vec3> angularMomentum;  // L^t
  std::vector<Vec3> target;           // angular momentum of the substep without constraints, world
  std::vector<Vec3> twist;            // sum of J_theta^T lambda, world, in the units of lambda
  std::vector<Vec3> jointTwist;       // the same of the joints that the direct method solves
  std::vector<DeltaX> kick;  // of forces, symmetric scheme: M^-1 P and T, applied once more
  double h = 0;              // the substep [s]

  bool empty() const { return scheme.empty(); }
};

// Bodies as the solver sees them: arrays indexed by BodyId.
struct Bodies {
  std::vector<Pose> pose;   // X^{t+1} + Delta X while a step is being solved
  std::vector<Pose> start;  // X^t, the start of the present substep
  std::vector<Velocity> velocity;
  std::vector<InverseMass> inverse;
  std::vector<Vec3> inverseInertia;  // principal, body frame; zero: does not rotate by torque
  std::vector<Vec3> inertia;         // principal, body frame
  std::vector<double> mass;
  std::vector<Motion> motion;
  std::vector<Vec3> shift;     // sum of the displacements Delta x of this substep [m]
  std::vector<Vec3> freeTurn;  // log of the predicted rotation of this substep, world frame [rad]
  std::vector<Shape> shape;
  std::vector<Friction> friction;
  std::vector<double> restitution;  // of a pair: the larger of the two
  double mostRestitution = 0;       // of all of them
  bool general = false;        // Settings::leavesOut is off: isotropic inertias turn as others do
  std::vector<bool> isSoft;    // points of a soft surface: it touches for them
  std::vector<BodyId> active;  // those that step: they can move, and do not sleep
  std::vector<BodyId> anisotropic;  // those of them whose world inertia follows their turn
  SecondOrder second;

  int size() const { return static_cast<int>(pose.size()); }
};

}  // namespace physics
