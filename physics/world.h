// The world: bodies, constraints, effects, and the step that moves them (Algorithm 1 of the paper).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/body.h"
#include "physics/constraints/axle.h"
#include "physics/constraints/ball_socket.h"
#include "physics/constraints/cone_limit.h"
#include "physics/constraints/distance.h"
#include "physics/constraints/drive.h"
#include "physics/constraints/motor.h"
#include "physics/constraints/spring.h"
#include "physics/constraints/twist_limit.h"

namespace physics {

enum class Method {
  kNonlinearGaussSeidel,  // (52)
  kDirect,                // (42) for joints, Gauss-Seidel for what has bounds
};
enum class Stepping { kPaper };

struct ContactSettings {
  Friction friction;
  double restitution = 0;         // 0..1
  double maxSeparationSpeed = 1;  // v_max: overlap that exists already is resolved no faster [m/s]
  double margin = 0.02;           // gaps below this are watched at rest [m]
};

struct Settings {
  double dt = 1.0 / 60;  // one step() [s]
  int substeps = 4;
  int iterations = 1;       // sweeps over all constraints per substep, at least
  int maxIterations = 40;   // and at the most, while contacts still move by more than
  double tolerance = 2e-7;  // this in a sweep [m]
  Method method = Method::kNonlinearGaussSeidel;
  Stepping stepping = Stepping::kPaper;
  double relaxation = 1;      // xi (53)
  double regularisation = 0;  // epsilon, alpha = epsilon * J M^-1 J^T (54)
  bool warmStart = true;      // contacts start from the last substep's multipliers
  bool warmStartJoints =
      false;  // and so do joints: better at rest, but violent motion may gain energy
  std::optional<Vec3> gravity;             // m/s^2; absent: none
  std::optional<ContactSettings> contact;  // absent: nothing touches
};

// What a step did, and what went wrong in it.
struct StepReport {
  int substeps = 0;
  int iterations = 0;  // sweeps in all
  std::int64_t constraintEvaluations = 0;
  double residual = 0;  // largest contact error that the last sweep met [m]
  struct NotFinite {
    int substep = 0;
    BodyId body = -1;
    std::string constraint;  // "ball_socket 3", or empty where the free motion already failed
  };
  std::optional<NotFinite> notFinite;  // the world was put back to the state before the step
};

// Largest error of one kind of constraint, in the unit of its rows.
struct KindError {
  std::string kind;
  std::string unit;  // "m" or "rad"
  double largest = 0;
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
  Vec3 pointA, pointB;  // world
  Vec3 axis;            // world, zero where the kind has none
  double error;         // m or rad
};

class World {
 public:
  explicit World(
      const Settings& settings = {});  // throws std::invalid_argument on senseless settings
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  // Bodies and constraints are added before the first step. Each throws std::invalid_argument with
  // the reason when a value makes no sense. A constraint's index counts within its kind.
  BodyId add(const BodyDef& def);
  int add(const BallSocketDef& def);
  int add(const AxleDef& def);
  int add(const ConeLimitDef& def);
  int add(const TwistLimitDef& def);
  int add(const DistanceDef& def);
  int add(const SpringDef& def);
  int add(const DriveDef& def);
  int add(const MotorDef& def);
  void ignoreCollision(BodyId a,
                       BodyId b);  // joints do this for their bodies unless they `collide`

  // Moves everything by settings().dt.
  StepReport step();

  // Between steps:
  void setVelocity(BodyId body, const Velocity& velocity);
  void setDriveTarget(int drive,
                      const Quat& target);  // orientation of bodies[1] in bodies[0]'s frame
  void applyForce(BodyId body, const Vec3& force,
                  const Vec3& torque);  // for the next step only [N, N m]

  const Settings& settings() const;
  std::int64_t stepCount() const;
  const Bodies& bodies() const;
  int bodyCount() const;  // the world body included

  std::vector<KindError> constraintErrors() const;  // one per kind present, in the table's order
  std::vector<ContactReport> contacts() const;      // gap <= margin
  std::vector<JointReport> joints() const;
  double largestOverlap() const;      // m, over the contacts at the present poses; >= 0
  int contactCount() const;           // points that carry an impulse
  double springEnergy() const;        // J, of springs and drives
  Vec3 driveTorque(int drive) const;  // on bodies[1], last substep [N m]

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace physics
