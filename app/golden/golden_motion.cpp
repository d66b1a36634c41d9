// The motion behind approved pictures: enough to draw a later one with the same camera, and to say
// where two motions part.
#include "app/golden/golden_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/base/build_info.h"
#include "app/base/numbers.h"
#include "app/trust/difference.h"
#include "scenes/joined.h"

namespace app {

namespace {

constexpr std::size_t kDigits = 8;  // of a state hash: one of four billion others has them too

Json toJson(const physics::Vec3& v) { return {v.x(), v.y(), v.z()}; }

physics::Vec3 vectorFrom(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

std::string namesOf(const scenes::Simulation& simulation) {
  std::string all;
  for (physics::BodyId b = 1; b < simulation.world().bodyCount(); ++b) {
    all += simulation.bodyName(b) + "\n";
  }
  return hashText(all);
}

// The body that is furthest from where it was approved, in units, and how far.
struct Furthest {
  std::size_t body = 0;
  double distance = 0;
};
Furthest furthest(const std::vector<std::int64_t>& was, const std::vector<std::int64_t>& is,
                  double wasUnit, double isUnit) {
  Furthest worst;
  for (std::size_t i = 0; i + 2 < std::min(was.size(), is.size()); i += 3) {
    physics::Vec3 moved;
    for (std::size_t k = 0; k < 3; ++k) {
      moved[static_cast<int>(k)] =
          isUnit * static_cast<double>(is[i + k]) - wasUnit * static_cast<double>(was[i + k]);
    }
    if (moved.norm() > worst.distance) worst = {i / 3, moved.norm()};
  }
  return worst;
}

std::string furthestText(const GoldenMotion& approved, const GoldenMotion& now, int frame,
                         const std::vector<std::string>& bodyNames) {
  const auto was = approved.places.find(frame), is = now.places.find(frame);
  if (was == approved.places.end() || is == now.places.end()) return "";
  if (approved.names != now.names) {
    return fmt::format("; the bodies are others or have other names, {} and were {}",
                       is->second.size() / 3, was->second.size() / 3);
  }
  const Furthest worst = furthest(was->second, is->second, approved.unit, now.unit);
  const double seen = std::max(approved.unit, now.unit);  // by rounding two places
  if (!(worst.distance > seen)) {
    return fmt::format("; no body is off by more than {}", lengthText(2 * seen));
  }
  return fmt::format("; most of all body '{}', by {}", bodyNames.at(worst.body),
                     lengthText(worst.distance));
}

}  // namespace

void MotionRecorder::observe(const scenes::Simulation& simulation, bool isGolden) {
  motion_.states.push_back(hexadecimal(simulation.stateHash()).substr(0, kDigits));
  if (motion_.names.empty()) motion_.names = namesOf(simulation);
  if (!isGolden) return;
  const std::vector<physics::Pose>& poses = simulation.world().bodies().pose;
  std::vector<physics::Vec3>& positions = positions_[simulation.frame()];
  for (std::size_t b = 1; b < poses.size(); ++b) positions.push_back(poses[b].x);
}

GoldenMotion MotionRecorder::take(const std::optional<scenes::MotionBounds>& bounds) const {
  GoldenMotion motion = motion_;
  motion.bounds = bounds;
  double size = 0;
  for (const auto& [frame, positions] : positions_) {
    for (const physics::Vec3& x : positions) size = std::max(size, x.cwiseAbs().maxCoeff());
  }
  constexpr int kFine = 4;
  motion.unit = size > 0 ? std::pow(10.0, std::floor(std::log10(size)) - kFine) : 1;
  for (const auto& [frame, positions] : positions_) {
    for (const physics::Vec3& x : positions) {
      for (int k = 0; k < 3; ++k) motion.places[frame].push_back(std::llround(x[k] / motion.unit));
    }
  }
  return motion;
}

std::string describeParting(const GoldenMotion& approved, const GoldenMotion& now, int frame,
                            const std::vector<std::string>& bodyNames) {
  const int first = firstDifference(approved.states, now.states);
  if (first < 0 || first > frame) return "";
  return fmt::format("first at frame {}{}", first, furthestText(approved, now, frame, bodyNames));
}

Json toJson(const GoldenMotion& motion) {
  Json places = Json::array();
  for (const auto& [frame, numbers] : motion.places) {
    places.push_back({{"frame", frame}, {"xyz", scenes::joined(numbers, " ")}});
  }
  Json json = {{"states", scenes::joined(motion.states, " ")},
               {"names", motion.names},
               {"unit", motion.unit},
               {"places", places}};
  if (motion.bounds) {
    json["bounds"] = {{"low", toJson(motion.bounds->low)}, {"high", toJson(motion.bounds->high)}};
  }
  return json;
}

GoldenMotion motionFrom(const Json& json) {
  GoldenMotion motion;
  std::istringstream states(json.at("states").get<std::string>());
  for (std::string state; states >> state;) motion.states.push_back(state);
  motion.names = json.at("names").get<std::string>();
  motion.unit = json.at("unit").get<double>();
  for (const Json& place : json.at("places")) {
    std::istringstream numbers(place.at("xyz").get<std::string>());
    std::vector<std::int64_t>& kept = motion.places[place.at("frame").get<int>()];
    for (std::int64_t number = 0; numbers >> number;) kept.push_back(number);
  }
  if (json.contains("bounds")) {
    motion.bounds = scenes::MotionBounds{vectorFrom(json["bounds"].at("low")),
                                         vectorFrom(json["bounds"].at("high"))};
  }
  return motion;
}

}  // namespace app
