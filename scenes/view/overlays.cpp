// Contacts, impulses, joints and centres of mass as dots and arrows; times, energies and errors as
// a HUD.
#include "scenes/view/overlays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/vectors.h"
#include "scenes/view/arm_overlay.h"
#include "scenes/view/palette.h"

namespace scenes {
namespace {

using physics::Vec3;

const render::Color kContact{0.84f, 0.10f, 0.12f, 1}, kImpulse{0.55f, 0.05f, 0.40f, 1},
    kJoint{0.05f, 0.30f, 0.65f, 1}, kAxis{0.95f, 0.55f, 0.05f, 1}, kCentre{0.08f, 0.08f, 0.08f, 1};

void drawContacts(const Simulation& simulation, double scale, render::Picture& picture) {
  for (const physics::ContactReport& contact : simulation.contacts()) {
    const Vec3 tip = contact.point + 0.06 * scale * contact.normal;
    picture.dots.push_back({contact.point.cast<float>(), kContact, 7});
    picture.lines.push_back(
        {contact.point.cast<float>(), tip.cast<float>(), kContact, 2, false, true});
  }
}

// The impulse that holds the weight of all for one substep is 0.4 scale long; the root keeps small
// ones visible.
void drawImpulses(const Simulation& simulation, double scale, render::Picture& picture) {
  const physics::World& world = simulation.world();
  const physics::Bodies& bodies = world.bodies();
  double mass = 0;
  for (physics::BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] == physics::Motion::kDynamic) mass += bodies.mass[b];
  }
  const double weight = 9.81 * mass * world.settings().dt / world.settings().substepCount();
  for (const physics::ContactReport& contact : simulation.contacts()) {
    const double size = contact.impulse.norm();
    if (size <= 1e-6 * weight) continue;
    const double length = 0.4 * scale * std::min(2.0, std::sqrt(size / weight));
    const Vec3 tip = contact.point + length / size * contact.impulse;
    picture.lines.push_back(
        {contact.point.cast<float>(), tip.cast<float>(), kImpulse, 3, true, true});
  }
}

// A dot on each side, the gap between them, and the axis where the kind has one.
void drawJoints(const Simulation& simulation, double scale, render::Picture& picture) {
  for (const physics::JointReport& joint : simulation.world().joints()) {
    picture.dots.push_back({joint.pointA.cast<float>(), kJoint, 6});
    if (joint.axis.norm() > 0.5) {
      const Vec3 half = 0.05 * scale * joint.axis;
      picture.lines.push_back({(joint.pointA - half).cast<float>(),
                               (joint.pointA + half).cast<float>(), kAxis, 2, false, true});
    }
    if ((joint.pointA - joint.pointB).norm() > 1e-4 * scale) {
      picture.dots.push_back({joint.pointB.cast<float>(), kContact, 6});
      picture.lines.push_back(
          {joint.pointA.cast<float>(), joint.pointB.cast<float>(), kContact, 3, false, true});
    }
  }
}

void drawCentres(const Simulation& simulation, render::Picture& picture) {
  const physics::Bodies& bodies = simulation.world().bodies();
  for (physics::BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] == physics::Motion::kStatic) continue;
    picture.dots.push_back({bodies.pose[b].x.cast<float>(), kCentre, 6});
  }
}

render::Plot energyPlot(const std::vector<FrameMetrics>& history, int length) {
  render::Plot plot{"energy", "J", {}, length, false};
  constexpr const char* kNames[] = {"total", "kinetic", "potential"};
  constexpr double FrameMetrics::*kMembers[] = {&FrameMetrics::total, &FrameMetrics::kinetic,
                                                &FrameMetrics::potential};
  for (int i = 0; i < 3; ++i) {
    render::Plot::Curve curve{kNames[i], {}, familyColor(Pattern::kVaried, 0, i)};
    for (const FrameMetrics& frame : history) {
      curve.values.push_back(static_cast<float>(frame.*kMembers[i]));
    }
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

// The largest error of each kind, and the overlap; zeros sit at the bottom of the scale.
render::Plot residualPlot(const std::vector<FrameMetrics>& history, int length) {
  constexpr double kFloor = 1e-12;
  render::Plot plot{"residual", "m, rad", {}, length, true};
  if (history.empty()) return plot;
  const auto addCurve = [&](const std::string& name, auto valueOf) {
    const int index = static_cast<int>(plot.curves.size());
    render::Plot::Curve curve{name, {}, familyColor(Pattern::kVaried, 0, index)};
    for (const FrameMetrics& frame : history) {
      curve.values.push_back(static_cast<float>(std::max(kFloor, valueOf(frame))));
    }
    plot.curves.push_back(std::move(curve));
  };
  for (size_t k = 0; k < history.front().errors.size(); ++k) {
    addCurve(history.front().errors[k].kind, [k](const FrameMetrics& frame) {
      return k < frame.errors.size() ? frame.errors[k].largest : 0.0;
    });
  }
  addCurve("overlap", [](const FrameMetrics& frame) { return frame.overlap; });
  return plot;
}

void addStepRows(const Scene& scene, render::Hud& hud) {
  hud.rows.push_back({"step", fmt::format("1/{} s", scene.fps)});
  if (scene.settings.choosesSubsteps()) {
    hud.rows.push_back({"substeps", "as each island asks"});
    return;
  }
  hud.rows.push_back({"substeps", fmt::format("{}", scene.settings.substepCount())});
  if (scene.settings.takesSmallSteps()) return;
  hud.rows.push_back({"iterations", fmt::format("{} per substep", scene.settings.iterations)});
}

// What steps by an accuracy told in this frame, and the sum of its estimates so far.
void addAccuracyRows(const std::vector<FrameMetrics>& history, double accuracy, render::Hud& hud) {
  double estimate = 0;
  for (const FrameMetrics& frame : history) estimate += frame.accuracy.estimate;
  const physics::AccuracyReport now =
      history.empty() ? physics::AccuracyReport{} : history.back().accuracy;
  hud.rows.push_back({"accuracy", fmt::format("{:g}", accuracy)});
  hud.rows.push_back({"steps", fmt::format("{} taken, {} rejected", now.accepted, now.rejected)});
  hud.rows.push_back({"shortest", fmt::format("{:.3g} ms, order {}", 1e3 * now.least, now.order)});
  hud.rows.push_back({"estimated error", fmt::format("{:.2g} so far", estimate)});
}

}  // namespace

void drawOverlays(const Simulation& simulation, const ViewOptions& options, double scale,
                  render::Picture& picture) {
  const Overlays& overlays = options.overlays;
  if (overlays.contacts) drawContacts(simulation, scale, picture);
  if (overlays.impulses) drawImpulses(simulation, scale, picture);
  if (overlays.joints) drawJoints(simulation, scale, picture);
  if (overlays.centresOfMass) drawCentres(simulation, picture);
  drawArms(simulation, overlays, picture);
  for (render::Line& line : picture.lines) line.width *= static_cast<float>(options.ink);
  for (render::Dot& dot : picture.dots) dot.diameter *= static_cast<float>(options.ink);
  for (render::Label& label : picture.labels) {
    label.size *= static_cast<float>(options.ink);
    label.offset *= static_cast<float>(options.ink);
  }
  if (overlays.vectors) drawVectors(simulation, scale, options, picture);
}

void addTrust(const Simulation& simulation, double until, render::Hud& hud) {
  const Scene& scene = simulation.scene();
  const double end = static_cast<double>(scene.frameCount() - 1) / scene.fps;
  const double time = static_cast<double>(simulation.frame()) / scene.fps;
  const float whole = end > 0 ? static_cast<float>(end) : 1;
  const std::string value = until < end ? fmt::format("until {:.2f} s", until) : "to the end";
  hud.bars.push_back(
      {"trusted", value, static_cast<float>(until) / whole, static_cast<float>(time) / whole});
}

render::Hud makeHud(const Simulation& simulation, const std::vector<FrameMetrics>& history) {
  const Scene& scene = simulation.scene();
  const physics::Settings& settings = scene.settings;
  render::Hud hud;
  hud.visible = true;
  hud.title = scene.title;
  const double time = static_cast<double>(simulation.frame()) / scene.fps;
  hud.rows.push_back({"time", fmt::format("{:.3f} s", time)});
  if (settings.accuracy) {
    addAccuracyRows(history, *settings.accuracy, hud);
  } else {
    addStepRows(scene, hud);
  }
  const auto& motion = simulation.world().bodies().motion;
  const auto moving = std::count_if(motion.begin(), motion.end(), [](physics::Motion m) {
    return m != physics::Motion::kStatic;
  });
  hud.rows.push_back({"bodies", fmt::format("{}", moving)});
  if (!history.empty()) {
    const FrameMetrics& now = history.back();
    if (settings.contact) hud.rows.push_back({"contacts", fmt::format("{}", now.contacts)});
    hud.rows.push_back({"energy", fmt::format("{:.4g} J", now.total)});
  }
  hud.plots.push_back(energyPlot(history, scene.frameCount()));
  hud.plots.push_back(residualPlot(history, scene.frameCount()));
  return hud;
}

}  // namespace scenes
