// Fixed boxes for others to fall into and down.
#include "physics/make/stage.h"

#include <cmath>

#include "physics/base/rotation.h"

namespace physics {
namespace {

template <class Def>
BodyId addFixed(World& world, const Shape& shape, const Pose& pose, const Def& def) {
  BodyDef body;
  body.shape = shape;
  body.pose = pose;
  body.motion = Motion::kStatic;
  body.friction = def.friction;
  body.restitution = def.restitution;
  return world.add(body);
}

// A prism with the bowl's outline, its upper face at the foot of the walls.
BodyId addFloor(World& world, const BowlDef& def) {
  const double corner = def.radius / sineCosine(kPi / def.sides).cosine;
  std::vector<Vec3> points;
  for (int i = 0; i < def.sides; ++i) {
    const auto [sine, cosine] = sineCosine((2 * i + 1) * kPi / def.sides);
    for (const double y : {0.0, def.thickness}) {
      points.emplace_back(corner * cosine, y, corner * sine);
    }
  }
  const PrincipalHull hull = makeHull(points);
  return addFixed(world, Convex{hull.hull}, def.place(hull.toPoints), def);
}

}  // namespace

std::vector<BodyId> add(World& world, const BowlDef& def) {
  const auto [sine, cosine] = sineCosine(def.slope);
  const auto [sideSine, sideCosine] = sineCosine(kPi / def.sides);
  const double along = def.height / sine;                      // m, up a wall
  const double rim = def.radius + def.height * cosine / sine;  // m, from the middle to a wall's top
  const double side = 2 * rim * sideSine / sideCosine;         // m, a wall's width at its top
  std::vector<BodyId> ids{addFloor(world, def)};
  for (int i = 0; i < def.sides; ++i) {
    // Local axes of a wall at angle 0: y up along it, x its outer normal, z across.
    const Quat turn = exponential(2 * kPi * i / def.sides * Vec3::UnitY());
    const Quat slope = exponential((def.slope - kPi / 2) * Vec3::UnitZ());
    const Vec3 middle(def.radius + 0.5 * along * cosine + 0.5 * def.thickness * sine,
                      def.thickness + 0.5 * along * sine - 0.5 * def.thickness * cosine, 0);
    const Box wall{Vec3(def.thickness, along, side)};
    ids.push_back(addFixed(world, wall, def.place({turn * middle, turn * slope}), def));
  }
  return ids;
}

std::vector<BodyId> add(World& world, const StairsDef& def) {
  std::vector<BodyId> ids;
  double x = 0;
  for (int i = 0; i < def.count; ++i) {
    const double tread = i == 0 ? def.landing : def.tread;
    const double height = (def.count - i) * def.rise;
    const Pose pose{Vec3(x + 0.5 * tread, 0.5 * height, 0), Quat::Identity()};
    ids.push_back(addFixed(world, Box{Vec3(tread, height, def.width)}, def.place(pose), def));
    x += tread;
  }
  return ids;
}

}  // namespace physics
