// A World in the words that other engines share: whole joints instead of their constraints.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/peers/forces.h"
#include "physics/world.h"

namespace app {

// How far the second body of a ball joint may swing from an axis of the first, and turn about it.
struct PeerCone {
  physics::Vec3 axis = physics::Vec3::UnitX();          // frame of the first body
  double angle = 0;                                     // of the swing, on all sides [rad]
  std::array<double, 2> twist{};                        // [rad]; 0 and no swing at `reference`
  physics::Quat reference = physics::Quat::Identity();  // of the second in the frame of the first
};

struct PeerJoint {
  enum class Kind { kBall, kHinge, kUniversal, kSlider, kDistance };
  Kind kind = Kind::kBall;
  std::array<physics::BodyId, 2> bodies{};
  std::array<physics::Vec3, 2> anchors{physics::Vec3::Zero(),
                                       physics::Vec3::Zero()};  // body frames
  // Of a hinge or a slider the same direction in both bodies, of a universal joint one in each.
  std::array<physics::Vec3, 2> axes{physics::Vec3::UnitX(), physics::Vec3::UnitX()};  // body frames
  double length = 0;                            // of a distance [m]
  std::optional<std::array<double, 2>> limits;  // turn of bodies[1] about the hinge's axis [rad]
  std::optional<PeerCone> cone;                 // of a ball
};

constexpr double kPointRadius = 1e-6;  // m, where points may touch

struct Blueprint {
  PeerState start;
  std::vector<PeerJoint> joints;
  PeerForces forces;
  std::vector<std::array<physics::BodyId, 2>> ignored;  // first < second, sorted
  std::string refusal;  // why no engine can express it; empty: some can

  bool hasCones() const;
  bool ignores(physics::BodyId a, physics::BodyId b) const;
};

Blueprint makeBlueprint(const physics::World& world);

bool isPoint(const physics::World& world, physics::BodyId body);
bool isMovable(const physics::World& world, physics::BodyId body);  // by forces
// The anchor of a joint in the world at the start.
physics::Vec3 anchorAtStart(const Blueprint& plan, const PeerJoint& joint, int side);
physics::Vec3 axisAtStart(const Blueprint& plan, const PeerJoint& joint, int side);

}  // namespace app
