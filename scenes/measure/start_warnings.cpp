// What a scene starts with that its author can hardly have meant.
#include "scenes/measure/start_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "scenes/measure/thickness.h"
#include "scenes/simulation.h"

namespace scenes {
namespace {

// Of the thinner body's thickness. Stacks that were typed in by hand overlap by rounding, a
// thousandth; past a half the bodies' centres have passed each other.
constexpr double kDeep = 0.1;

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
