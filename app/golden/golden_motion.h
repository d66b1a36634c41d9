// The motion behind approved pictures: enough to draw a later one with the same camera, and to say
// where two motions part.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/run/run_record.h"
#include "scenes/view/view.h"

namespace app {

struct GoldenMotion {
  std::optional<scenes::MotionBounds> bounds;  // what the camera fits; none: it needs no motion
  std::vector<std::string> states;             // the first eight digits of each frame's state hash
  std::string names;                           // hash of all bodies' names; empty: nothing is kept
  // Of every body in the golden frames, x y z in units of a ten-thousandth of the scene's size.
  double unit = 0;  // m, a power of ten
  std::map<int, std::vector<std::int64_t>> places;
};

// Takes notes along a simulation.
class MotionRecorder {
 public:
  void observe(const scenes::Simulation& simulation, bool isGolden);
  // Those that observed frames have, with `bounds` beside them.
  GoldenMotion take(const std::optional<scenes::MotionBounds>& bounds) const;

 private:
  GoldenMotion motion_;
  std::map<int, std::vector<physics::Vec3>> positions_;
};

// "first at frame 37; in frame 60 most of all body 'brick.12', by 3 mm": where the motion up to
// `frame` leaves the approved one. Empty where nothing approved is kept.
std::string describeParting(const GoldenMotion& approved, const GoldenMotion& now, int frame,
                            const std::vector<std::string>& bodyNames);

Json toJson(const GoldenMotion& motion);
GoldenMotion motionFrom(const Json& json);  // throws Json::exception

}  // namespace app
