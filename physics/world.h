// The world: bodies, constraints, effects, and the step that moves them (Algorithm 1 of the paper).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/constraints/axle.h"
#include "physics/constraints/ball_socket.h"
#include "physics/constraints/bend.h"
#include "physics/constraints/cone_limit.h"
#include "physics/constraints/distance.h"
#include "physics/constraints/drag.h"
#include "physics/constraints/drive.h"
#include "physics/constraints/force.h"
#include "physics/constraints/hardening_spring.h"
#include "physics/constraints/link.h"
#include "physics/constraints/motor.h"
#include "physics/constraints/motor_torque.h"
#include "physics/constraints/orientation_lock.h"
#include "physics/constraints/panel_drag.h"
#include "physics/constraints/perpendicular.h"
#include "physics/constraints/point_gravity.h"
#include "physics/constraints/point_on_line.h"
#include "physics/constraints/rope_length.h"
#include "physics/constraints/slide_limit.h"
#include "physics/constraints/soft_contact.h"
#include "physics/constraints/spring.h"
#include "physics/constraints/twist_limit.h"
#include "physics/constraints/volume.h"
#include "physics/kinematics/arm_def.h"
#include "physics/kinematics/arm_report.h"
#include "physics/model/report.h"
#include "physics/model/settings.h"

namespace physics {

struct ConstraintItem;
class World {
 public:
  // Throws std::invalid_argument on senseless settings.
  explicit World(const Settings& settings = {});
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
  int add(const PointOnLineDef& def);
  int add(const SlideLimitDef& def);
  int add(const OrientationLockDef& def);
  int add(const PerpendicularDef& def);
  int add(const DistanceDef& def);
  int add(const LinkDef& def);
  int add(const RopeLengthDef& def);
  int add(const VolumeDef& def);
  int add(const SpringDef& def);  // the index counts within its form
  int add(const HardeningSpringDef& def);
  int add(const BendDef& def);
  int add(const PointGravityDef& def);
  int add(const ForceDef& def);
  int add(const DragDef& def);
  int add(const PanelDragDef& def);
  int add(const DriveDef& def);
  int add(const MotorDef& def);
  int add(const MotorTorqueDef& def);
  void add(const SoftSurfaceDef& def);  // touches rigid bodies, where the World has contacts
  int add(const ArmDef& def);  // its links are kinematic bodies, with the next ids in a row
  // Joints do this for their bodies unless they `collide`.
  void ignoreCollision(BodyId a, BodyId b);

  // Threads that step() shares its work with, the caller's included: 1 at first. The same bytes for
  // any number.
  void setThreads(int count);

  StepReport step();  // moves everything by settings().dt

  // Between steps:
  // Every body's pose and velocity, by BodyId, from whatever found them. Multipliers and history of
  // earlier steps are forgotten, and contacts() are those at these poses. False, and nothing is
  // changed, where a number is not finite or a quaternion is zero.
  bool setState(std::span<const Pose> poses, std::span<const Velocity> velocities);
  void setVelocity(BodyId body, const Velocity& velocity);
  // All that the next step depends on. A World made alike that restores it goes on as this one,
  // bit for bit. Throws std::invalid_argument where the bytes are not of such a World; this one is
  // then not to be used any more.
  std::string saved() const;
  void restore(std::string_view bytes);
  // Orientation of bodies[1] in bodies[0]'s frame.
  void setDriveTarget(int drive, const Quat& target);
  void setArmTarget(int arm, const Vec3& target);
  // For the next step only [N, N m].
  void applyForce(BodyId body, const Vec3& force, const Vec3& torque);

  const Settings& settings() const;
  std::int64_t stepCount() const;
  const Bodies& bodies() const;
  int bodyCount() const;                            // the world body included
  std::vector<KindError> constraintErrors() const;  // one per kind present, in the table's order
  std::vector<ContactReport> contacts() const;      // gap <= margin
  std::vector<JointReport> joints() const;          // every pair that a constraint holds together
  std::vector<ConstraintItem> constraints() const;  // all of them and the forces, constraint_item.h
  std::vector<std::array<BodyId, 2>> ignoredPairs() const;  // first < second, sorted
  std::vector<VolumeReport> volumes() const;
  std::vector<ArmReport> arms() const;
  double largestOverlap() const;             // m, of what touches, at the present poses; >= 0
  int contactCount() const;                  // points that carry an impulse
  std::vector<EffectMemory> memory() const;  // what is held now, "bodies" first
  bool isAsleep(BodyId body) const;
  int substepsOf(BodyId body) const;  // in the last step
  double springEnergy() const;        // J, of every force that has a potential
  double gradientError() const;  // largest difference of a gradient from central differences of its
                                 // error, relative to the gradient's largest entry (self-check)
  Vec3 driveTorque(int drive) const;  // on bodies[1], last substep [N m]
  Vec3 driveError(int drive) const;  // dtheta of (129): the turn of bodies[1] past its target [rad]

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace physics
