// A jointed figure: bones, joints with anatomical limits, and drives that hold poses.
#pragma once

#include <string>

#include "physics/make/placement.h"

namespace physics {

// Bones and joints at rest in the figure's frame: x to its left, y up, z forward, feet at y = 0.
struct Bone {
  std::string name;
  Shape shape;
  double mass = 1;  // kg
  Pose rest;
};

struct SkeletonJoint {
  int parent = 0, child = 0;  // bones; a parent comes before its child in the list
  Vec3 at = Vec3::Zero();     // figure's frame, at rest
  bool hinge = false;
  Vec3 axis = Vec3::UnitY();    // a hinge's axis, or the child's own direction at rest
  Vec3 centre = Vec3::UnitY();  // the middle of the cone that `axis` may move in; not of a hinge
  double cone = 0.5;            // rad
  std::array<double, 2> limits{-0.5,
                               0.5};  // rad: a hinge's turn from rest, or the twist about the axis
  double strength = 1;                // scales the drive
};

struct Skeleton {
  std::vector<Bone> bones;
  std::vector<SkeletonJoint> joints;
  std::vector<std::array<int, 2>> apart;  // further pairs of bones that never touch
};

// Per joint, the turn of the child against its parent from rest, in the figure's frame.
using JointTurns = std::vector<Quat>;

struct RagdollDrive {
  double stiffness = 200;                                      // N m/rad
  double damping = 20;                                         // N m s
  double maxTorque = std::numeric_limits<double>::infinity();  // N m
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"stiffness", Unit::kNewtonMetrePerRadian, true, 0}, d.stiffness);
    v(Field{"damping", Unit::kNewtonMetreSecond, false, 0}, d.damping);
    v(Field{"max_torque", Unit::kNewtonMetre, false, 0}, d.maxTorque);
  }
};

// The placement is where the first bone is above, at the height of the figure's lowest point.
struct RagdollDef {
  static constexpr const char* kWord = "ragdoll";
  Placement place;
  Velocity velocity;
  std::optional<RagdollDrive> drive;
  std::optional<Friction> friction;
  std::optional<double> restitution;
  std::vector<std::string> fixed;  // bones that stay where they are
  bool leads = false;              // the first bone goes by its velocity, whatever pulls at it
  Lattice copies;
  unsigned seed = 1;
  template <class V, class D>
  static void fields(V& v, D& d) {
    Placement::fields(v, d.place);
    v(Field{"velocity"}, d.velocity.v);
    v(Field{"angular_velocity"}, d.velocity.w);
    v(Field{"drive"}, d.drive);
    v(Field{"friction"}, d.friction);
    v(Field{"restitution", Unit::kNone, false, 0, 1}, d.restitution);
    v(Field{"fixed"}, d.fixed);
    v(Field{"copies"}, d.copies);
    v(Field{"seed"}, d.seed);
  }
};

struct Ragdoll {
  std::vector<BodyId> bones;  // in the skeleton's order
  std::vector<int> drives;    // one per joint; none without a drive
};

// Poses of all bones in the figure's frame.
std::vector<Pose> posed(const Skeleton& skeleton, const JointTurns& turns);

// What a drive of this joint aims at: the child's orientation in its parent's frame.
Quat driveTarget(const Skeleton& skeleton, int joint, const Quat& turn);

// One figure per copy, each in the pose.
std::vector<Ragdoll> add(World& world, const Skeleton& skeleton, const JointTurns& turns,
                         const RagdollDef& def);

}  // namespace physics
