// A model as MJCF and URDF have it: a tree of links, moved by joints, with their parts.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "physics/bodies/body.h"
#include "scenes/read/value.h"

namespace scenes {

inline constexpr int kWorldLink = 0;  // does not move

// Of a model: what it takes until it is a scene is some 200 MB then.
inline constexpr std::size_t kMostLinks = 10000, kMostParts = 50000, kMostPoints = 200000;

// A shape of a link, in the link's frame.
struct ModelPart {
  std::string name;
  Place place;
  physics::Shape shape;                          // as our words mean it: round ones along y
  std::vector<physics::Vec3> points;             // of a Convex, in the part's frame
  std::vector<std::vector<double>> rows;         // of a ground of heights, instead of a shape [m]
  physics::Vec2 extent = physics::Vec2::Zero();  // of it [m]
  physics::Pose pose;                            // of the part's frame
  std::optional<double> mass;                    // kg; absent: by density
  double density = 1000;                         // kg/m^3
  std::optional<physics::Vec3> color;
  double opacity = 1;
  std::optional<double> friction;
  // Two parts touch where the bits of one's type meet those of the other's affinity.
  unsigned type = 1, affinity = 1;
  bool collides() const { return type != 0 || affinity != 0; }
};

struct ModelInertial {
  double mass = 0;                                // kg
  physics::Vec3 centre = physics::Vec3::Zero();   // of mass
  physics::Mat3 inertia = physics::Mat3::Zero();  // about the centre [kg m^2]
};

struct ModelServo {  // a torque or force towards a position, a speed, or what is told
  enum class Kind { kTorque, kSpring };
  Kind kind = Kind::kTorque;
  std::string name;
  Place place;
  double stiffness = 0, damping = 0;  // per rad or m
  double target = 0;                  // where the joint's coordinate should be, or a torque
  std::size_t index = 0;              // of all actuators of the file
  double perControl = 0;              // what `target` is for a control of 1
  std::optional<double> most;         // N m or N
};

struct ModelJoint {
  enum class Kind { kHinge, kSlide, kBall };
  Kind kind = Kind::kHinge;
  std::string name;
  Place place;
  physics::Vec3 at = physics::Vec3::Zero(), axis = physics::Vec3::UnitZ();  // in the link's frame
  std::optional<std::array<double, 2>> range;  // rad or m, of the coordinate
  double start = 0;                            // the coordinate of the pose that the file gives
  double stiffness = 0, damping = 0, rest = 0;
  std::vector<ModelServo> servos;
};

struct ModelLink {
  std::string name;
  Place place;
  int parent = kWorldLink;
  physics::Pose pose;  // in the parent's frame
  bool free = false;   // nothing joins it to its parent; it moves
  std::vector<ModelPart> parts;
  std::optional<ModelInertial> inertial;  // absent: that of its parts
  std::vector<ModelJoint> joints;         // in a row, the first next to the parent
};

// Two links held together besides the tree.
struct ModelLoop {
  std::string name;
  Place place;
  std::array<int, 2> links{};
  physics::Vec3 at = physics::Vec3::Zero();  // in the first link's frame
  bool welded = false;
};

// Two points of links that a string holds together.
struct ModelString {
  std::string name;
  Place place;
  std::array<int, 2> links{};
  std::array<physics::Vec3, 2> at{physics::Vec3::Zero(), physics::Vec3::Zero()};  // link frames
  double stiffness = 0, damping = 0;
  std::optional<double> rest, most;  // m: of a spring, absent: as at the start; at the most
};

struct Model {
  std::string title;
  Place place;
  std::optional<Place> asksForGravity;
  physics::Vec3 gravity{0, 0, -9.81};
  std::vector<ModelLink> links{1};  // parents stand before their children
  std::vector<ModelLoop> loops;
  std::vector<ModelString> strings;
  std::size_t parts = 0, points = 0;    // of all links
  std::vector<std::vector<int>> apart;  // links of which none touches another
};

}  // namespace scenes
