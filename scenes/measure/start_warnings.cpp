// What a scene starts with that its author can hardly have meant.
#include "scenes/measure/start_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "scenes/simulation.h"

namespace scenes {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Of the thinner body's thickness. Stacks that were typed in by hand overlap by rounding, a
// thousandth; past a half the bodies' centres have passed each other.
constexpr double kDeep = 0.1;

// The diameter of the largest sphere about the centre of mass that fits in [m]; infinite for what
// has no inside to measure against: a plane, a point.
double thicknessOf(const physics::Shape& shape) {
  if (const auto* box = std::get_if<physics::Box>(&shape)) return box->size.minCoeff();
  if (const auto* sphere = std::get_if<physics::Sphere>(&shape)) return 2 * sphere->radius;
  if (const auto* capsule = std::get_if<physics::Capsule>(&shape)) return 2 * capsule->radius;
  if (const auto* cylinder = std::get_if<physics::Cylinder>(&shape)) {
    return std::min(2 * cylinder->radius, cylinder->length);
  }
  const auto* convex = std::get_if<physics::Convex>(&shape);
  if (convex == nullptr) return kInfinity;
  double nearest = kInfinity;
  for (const physics::Hull::Face& face : convex->hull->faces) {
    nearest = std::min(nearest, face.offset);
  }
  return 2 * nearest;
}

struct Overlap {
  physics::BodyId a = -1, b = -1;
  double depth = 0, share = 0;  // m; of the thickness
};

}  // namespace

std::vector<std::string> startWarnings(const Scene& scene) {
  if (!scene.settings.contact) return {};
  Simulation simulation(scene);
  const physics::Bodies& bodies = simulation.world().bodies();
  // A world knows its contacts from its first step on, or once it is put somewhere.
  const std::vector<physics::Pose> poses = bodies.pose;
  const std::vector<physics::Velocity> velocities = bodies.velocity;
  simulation.place(poses, velocities);
  std::set<std::pair<physics::BodyId, physics::BodyId>> pairs;
  Overlap worst;
  for (const physics::ContactReport& contact : simulation.world().contacts()) {
    const double thickness =
        std::min(thicknessOf(bodies.shape[contact.a]), thicknessOf(bodies.shape[contact.b]));
    const double share = -contact.gap / thickness;
    if (!(share > kDeep)) continue;
    pairs.insert(std::minmax(contact.a, contact.b));
    if (share > worst.share) worst = {contact.a, contact.b, -contact.gap, share};
  }
  if (pairs.empty()) return {};
  std::string text = fmt::format(
      "at the start bodies '{}' and '{}' overlap by {:.3g} m, {:.0f} % of how thick the thinner "
      "one is",
      simulation.bodyName(worst.a), simulation.bodyName(worst.b), worst.depth, 100 * worst.share);
  if (pairs.size() > 1)
    text += fmt::format("; {} pairs do by more than {:.0f} %", pairs.size(), 100 * kDeep);
  return {text};
}

}  // namespace scenes
