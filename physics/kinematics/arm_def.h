// What a caller fills in to add an arm: links in a row, joints between them, and how its inverse
// kinematics is solved.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "physics/base/fields.h"
#include "physics/bodies/body.h"

namespace physics {

// What resists a turn of a joint: the mass of all beyond it (151), or 1 (145).
enum class ArmForm { kMassWeighted, kPseudoInverse };
inline std::span<const char* const> names(ArmForm) {
  static constexpr const char* kNames[] = {"mass_weighted", "pseudo_inverse"};
  return kNames;
}

// A link and the joint at its root end, the pivot. With all joints at zero every link's frame is
// the arm's base frame.
struct ArmLinkDef {
  Vec3 length = Vec3::Zero();   // from its pivot to the next, or to the tip; link's frame [m]
  double mass = 1;              // kg
  double radius = 0.03;         // m
  std::optional<Vec3> centre;   // of mass, from the pivot, link's frame [m]; absent: the middle
  std::optional<Vec3> inertia;  // principal, y along the link [kg m^2]; absent: a cylinder's
  bool hinge = false;           // else a ball joint
  Vec3 axis = Vec3::UnitZ();    // of the hinge, in the parent's frame; a ball starts turned by
  double angle = 0;             // `angle` about it [rad]
  std::array<double, 2> range{-std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::infinity()};  // of a hinge's angle [rad]
  double bend = 3.14159265358979323846;  // of a ball: the most between link and parent [rad]
};

struct ArmSolve {
  ArmForm form = ArmForm::kMassWeighted;
  int iterations = 8;            // (154), per step of the World
  double relaxation = 1;         // xi
  double regularisation = 0.01;  // epsilon, alpha = epsilon * mean of J M^-1 J^T over directions
  double maxTurn = 1;            // of any joint in an iteration [rad]
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"form"}, d.form);
    v(Field{"iterations", Unit::kNone, false, 0, 1e6}, d.iterations);
    v(Field{"relaxation", Unit::kNone, false, 0.01, 1.99}, d.relaxation);
    v(Field{"regularisation", Unit::kNone, false, 0, 1e6}, d.regularisation);
    v(Field{"max_turn_degrees", Unit::kDegrees, false, 0.01, 360}, d.maxTurn);
  }
};

struct ArmDef {
  static constexpr const char* kWord = "arm";
  Vec3 at = Vec3::Zero();            // the first pivot
  Quat rotation = Quat::Identity();  // of the base frame
  std::vector<ArmLinkDef> links;     // from the root to the tip
  ArmSolve solve;
  double maxSpeed = std::numeric_limits<double>::infinity();  // of the point the tip follows [m/s]
  std::optional<Vec3> target;                                 // absent: where the tip starts
  std::optional<Friction> friction;                           // absent: the World's
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"at", Unit::kPoint, true}, d.at);
    v(Field{"rotation"}, d.rotation);
    ArmSolve::fields(v, d.solve);
    v(Field{"max_speed", Unit::kNone, false, 1e-9}, d.maxSpeed);
    v(Field{"friction"}, d.friction);
  }
};

}  // namespace physics
