// What every method asks of the model: shapes, what is joined, who flies free, who steps.
#include "physics/model/model.h"

#include <numeric>

#include "physics/constraints/constraint_response.h"

namespace physics {

void Model::takeShapes() {
  if (hasShapes) return;
  hasShapes = true;
  for (BodyId body = kWorldBody + 1; body < bodies.size(); ++body) {
    const bool isMovable = bodies.motion[body] == Motion::kDynamic;
    if (!bodies.isSoft[body]) collider.add(body, bodies.shape[body], isMovable);
    softCollider.addBody(body, bodies.shape[body]);
  }
  touches = collider.canTouch() || (!settings.leavesOut && collider.hasShapes());
  if (!touches) return collider.forgetShapes();
  std::vector<BodyId> still;
  for (BodyId body = kWorldBody + 1; body < bodies.size(); ++body) {
    if (bodies.motion[body] == Motion::kStatic) still.push_back(body);
  }
  collider.rest(still, bodies.pose);
}

const std::vector<bool>& Model::findAttached() {
  if (!attached.empty()) return attached;
  attached.assign(bodies.pose.size(), false);
  forEachKind(kinds, [&](const auto& kind) {
    for (const auto& item : kind.set.items) {
      for (const BodyId body : item.bodies) attached[body] = true;
    }
  });
  attached[kWorldBody] = false;
  return attached;
}

FreeFlight Model::flight(double dt) {
  FreeFlight flight{settings.gravity, loads, velocityBefore, findAttached(), dt};
  for (const SoftContact& contact : softContacts) flight.attached[contact.body] = true;
  return flight;
}

void Model::takeActiveMask() {
  activeMask.assign(bodies.pose.size(), kInactive);
  for (BodyId i = 0; i < bodies.size(); ++i) {
    if (!isMovable(bodies, i)) activeMask[i] = kFixed;
  }
  for (const BodyId i : bodies.active) activeMask[i] = kActive;
}

const Islands& jointIslands(Model& model) {
  Islands& joined = model.joined;
  if (!joined.empty()) return joined;
  joined.resize(model.bodies.pose.size());
  std::iota(joined.begin(), joined.end(), 0);
  forEachKind(model.kinds, [&](const auto& kind) {
    for (const auto& item : kind.set.items) {
      const BodyId mover = moverOf(item, model.bodies);
      for (const BodyId body : item.bodies) join(model.bodies, joined, mover, body);
    }
  });
  settleAll(joined);
  return joined;
}

}  // namespace physics
