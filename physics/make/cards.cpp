// Where cards and dominoes touch, in closed form.
#include "physics/make/cards.h"

#include <cmath>

#include "physics/base/rotation.h"

namespace physics {
namespace {

Quat about(const Vec3& axis, double angle) { return exponential(angle * axis); }

}  // namespace

std::vector<BodyId> add(World& world, const CardHouseDef& def) {
  const auto [sine, cosine] = sineCosine(def.lean);
  // A pair spans 2 reachX at its feet and is `rise` high; its cards' centres are `offset` from its
  // middle.
  const double reachX = def.length * sine + def.thickness * cosine;
  const double rise = def.length * cosine + def.thickness * sine;
  const double offset = 0.5 * reachX;
  const Box leaning{Vec3(def.thickness, def.length, def.width)};
  const Box flat{Vec3(2 * reachX, def.thickness, def.width)};
  std::vector<BodyId> ids;
  const auto put = [&](const Box& box, const Vec3& x, double angle) {
    const Pose pose = def.place({x, about(Vec3::UnitZ(), angle)});
    ids.push_back(world.add(bodyOf(box, def.matter, pose)));
  };
  for (int storey = 0; storey < def.storeys; ++storey) {
    const double foot = storey * (rise + def.thickness);
    const int pairs = def.storeys - storey;
    for (int i = 0; i < pairs; ++i) {
      const double middle = (2 * i - (pairs - 1)) * reachX;
      put(leaning, Vec3(middle - offset, foot + 0.5 * rise, 0), -def.lean);
      put(leaning, Vec3(middle + offset, foot + 0.5 * rise, 0), def.lean);
    }
    for (int i = 0; i + 1 < pairs; ++i) {
      const double middle = (2 * i - (pairs - 2)) * reachX;
      put(flat, Vec3(middle, foot + rise + 0.5 * def.thickness, 0), 0);
    }
  }
  return ids;
}

std::vector<BodyId> add(World& world, const DominoesDef& def) {
  require(def.spacing > def.size.x(), "expected a spacing larger than a domino is thick");
  std::vector<BodyId> ids;
  Vec3 foot = Vec3::Zero();
  const double turn = def.count > 1 ? def.turn / (def.count - 1) : 0;
  for (int i = 0; i < def.count; ++i) {
    const Quat heading = about(Vec3::UnitY(), i * turn);
    const Pose pose = def.place({foot + 0.5 * def.size.y() * Vec3::UnitY(), heading});
    BodyDef body = bodyOf(Box{def.size}, def.matter, pose);
    if (i == 0) {
      body.velocity.w = pose.q * Vec3(0, 0, -def.push);
      body.velocity.v =
          body.velocity.w.cross(pose.q * Vec3(-0.5 * def.size.x(), 0.5 * def.size.y(), 0));
    }
    ids.push_back(world.add(body));
    foot += def.spacing * (about(Vec3::UnitY(), (i + 0.5) * turn) * Vec3::UnitX());
  }
  return ids;
}

}  // namespace physics
