// What one frame of a simulation shows, as plain numbers: enough to see and measure it again
// without stepping.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/simulation.h"

namespace scenes {

struct Moment {
  int frame = 0;
  std::vector<physics::Pose> poses;           // by BodyId, the world body included
  std::vector<physics::Velocity> velocities;  // likewise
  std::vector<physics::ContactReport> contacts;
  std::vector<physics::ArmReport> arms;
  FrameMetrics metrics;
  std::uint64_t stateHash = 0;
};

// The numbers of a Moment, in rows that have the same length in every frame of a scene; only
// contacts come and go.
struct MomentNumbers {
  static constexpr int kPose = 7;      // x y z [m], qw qx qy qz
  static constexpr int kVelocity = 6;  // v [m/s], w [rad/s]
  static constexpr int kContact = 12;  // bodies a b, point, normal from b to a, gap [m], impulse on
                                       // a over the last substep [N s]
  std::vector<double> poses, velocities;  // by BodyId
  std::vector<double> contacts, arms, metrics;
};

MomentNumbers numbersOf(const Moment& moment);

// The other way; what is no number, and how many of each there are, is as in `like`. What has not
// as many numbers as that is left as it is in `like`.
Moment momentFrom(const MomentNumbers& numbers, const Moment& like);

// What the metrics' numbers are, in their order: "kinetic", ..., "ball_socket.largest".
std::vector<std::string> numberNames(const FrameMetrics& metrics);

}  // namespace scenes
