// The worst constraint, contact or body behind a metric.
#include "scenes/measure/culprit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace scenes {
namespace {

using physics::BodyId;

std::string nameBoth(const Sample& s, BodyId a, BodyId b) {
  return s.simulation.bodyName(a) + ", " + s.simulation.bodyName(b);
}

// The kinds of constraint whose errors a metric looks at.
std::vector<std::string> kindsOf(const std::string& metric) {
  if (metric == "joint_error") {
    return {"ball_socket", "point_on_line", "distance", "link", "rope_length"};
  }
  if (metric == "axle_angle") return {"axle"};
  if (metric == "cone_angle") return {"cone_limit"};
  if (metric == "link_error_sum") return {"link"};
  if (metric.ends_with("_error")) return {metric.substr(0, metric.size() - 6)};
  return {};
}

// The bodies of the constraint with that index within its kind.
std::string bodiesOf(const Sample& s, const physics::KindError& error) {
  if (error.kind == physics::VolumeDef::kWord) {
    const auto volumes = s.simulation.world().volumes();
    std::string names;
    for (const BodyId body : volumes[error.worst].bodies) {
      names += (names.empty() ? "" : ", ") + s.simulation.bodyName(body);
    }
    return names;
  }
  int index = 0;
  for (const physics::JointReport& joint : s.simulation.world().joints()) {
    if (joint.kind == error.kind && index++ == error.worst) return nameBoth(s, joint.a, joint.b);
  }
  return "";
}

Culprit worstConstraint(const Sample& s, const std::vector<std::string>& kinds) {
  const physics::KindError* worst = nullptr;
  for (const physics::KindError& error : s.now.errors) {
    const bool asked = std::find(kinds.begin(), kinds.end(), error.kind) != kinds.end();
    if (!asked || error.worst < 0) continue;
    if (worst == nullptr || error.largest > worst->largest) worst = &error;
  }
  if (worst == nullptr) return {};
  return {bodiesOf(s, *worst), fmt::format("{} {}", worst->kind, worst->worst)};
}

Culprit deepestContact(const Sample& s) {
  const std::vector<physics::ContactReport> contacts = s.simulation.world().contacts();
  const auto deepest = std::min_element(contacts.begin(), contacts.end(),
                                        [](const auto& a, const auto& b) { return a.gap < b.gap; });
  if (deepest == contacts.end()) return {};
  return {nameBoth(s, deepest->a, deepest->b), "contact"};
}

double kineticOf(const physics::Bodies& bodies, BodyId b) {
  const physics::Vec3 w = bodies.pose[b].q.conjugate() * bodies.velocity[b].w;
  return bodies.mass[b] * bodies.velocity[b].v.squaredNorm() +
         w.dot(bodies.inertia[b].cwiseProduct(w));
}

Culprit mostMoving(const Sample& s, double (*measure)(const physics::Bodies&, BodyId)) {
  const physics::Bodies& bodies = s.simulation.world().bodies();
  BodyId most = -1;
  for (BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] != physics::Motion::kDynamic) continue;
    if (most < 0 || measure(bodies, b) > measure(bodies, most)) most = b;
  }
  return most < 0 ? Culprit{} : Culprit{s.simulation.bodyName(most), ""};
}

}  // namespace

Culprit findCulprit(const Sample& s, const Metric& metric, BodyId body) {
  const std::string name = metric.name;
  if (body >= 0) return {s.simulation.bodyName(body), ""};
  if (metric.about != Metric::About::kScene) return {};
  if (name.starts_with("overlap")) return deepestContact(s);
  if (const auto kinds = kindsOf(name); !kinds.empty()) return worstConstraint(s, kinds);
  if (name == "max_speed") {
    return mostMoving(s, [](const physics::Bodies& bodies, BodyId b) {
      return bodies.velocity[b].v.squaredNorm();
    });
  }
  if (name.find("energy") != std::string::npos || name.find("momentum") != std::string::npos) {
    return mostMoving(s, kineticOf);
  }
  return {};
}

}  // namespace scenes
