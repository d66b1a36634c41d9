// How far two runs of the same bodies are apart.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/trust/track.h"

namespace app {

// What is judged of a body, and against what.
struct Allowed {
  bool moves = false;   // by the laws of motion: else it is not judged
  int group = 0;        // by joints: the same for what is joined
  double size = 0;      // m, of its group
  double radius = 0;    // m, of the sphere around its shape about its centre
  double distance = 0;  // m that it may be off
};

// By BodyId. The size of what is joined is the diagonal of the box around its centres and joints,
// and no less than the body's own.
std::vector<Allowed> allowedOf(const scenes::Simulation& start, double accuracy);

// No point of the body is further from where it is in the other run [m]: what its centre is off,
// and what its turn takes a point of its surface.
double apart(const physics::Pose& a, const physics::Pose& b, double radius);
// The same of velocities [m/s].
double apart(const physics::Velocity& a, const physics::Velocity& b, double radius);

struct FrameDifference {
  double time = 0;
  physics::BodyId body = 0;          // the furthest apart by what it is allowed; 0: none is judged
  double distance = 0, allowed = 0;  // of that body [m]
  int beyond = 0;                    // bodies that are further apart than allowed

  double ratio() const { return allowed > 0 ? distance / allowed : 0; }
};

// Of the frames that both have.
std::vector<FrameDifference> differencesOf(const Track& a, const Track& b,
                                           const std::vector<Allowed>& allowed);

// The first index at which two lists differ; -1: the shorter one is the beginning of the other.
int firstDifference(std::span<const std::string> a, std::span<const std::string> b);

// Where two tracks differ first, to the last bit.
struct Parting {
  int frame = -1;            // -1: nowhere
  physics::BodyId body = 0;  // of those that differ there: the one with the largest difference
  std::string quantity;      // of x y z qw ... wz the one that differs most
  double a = 0, b = 0;       // its values
  double distance = 0;       // m, that the centre of the body is off
  int bodies = 0;            // that differ there
};
Parting firstParting(const Track& a, const Track& b);

}  // namespace app
