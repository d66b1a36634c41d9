// Voussoirs and springers as prisms of a polygon in the x-y plane.
#include "physics/make/arch.h"

#include "physics/base/rotation.h"

namespace physics {
namespace {

BodyId addPrism(World& world, const ArchDef& def, std::span<const Vec2> polygon, Motion motion) {
  std::vector<Vec3> points;
  for (const Vec2& p : polygon) {
    for (const double side : {-0.5, 0.5}) points.emplace_back(p.x(), p.y(), side * def.depth);
  }
  const PrincipalHull hull = makeHull(points);
  BodyDef body = bodyOf(Convex{hull.hull}, def.matter, def.place(hull.toPoints));
  body.motion = motion;
  return world.add(body);
}

}  // namespace

std::vector<BodyId> add(World& world, const ArchDef& def) {
  const double half = 0.5 * def.angle;
  const double centre = def.springerHeight - def.radius * sineCosine(half).cosine;
  // The point of joint i at this radius, from the left springing to the right one.
  const auto point = [&](int i, double radius) {
    const double angle = half * (2.0 * i / def.stones - 1);
    const bool level = i == 0 || i == def.stones;  // both springings at one height, bit for bit
    const auto [sine, cosine] = sineCosine(angle);
    const double rise = level ? sineCosine(half).cosine : cosine;
    return Vec2(radius * sine, centre + radius * rise);
  };
  const double outer = def.radius + def.thickness;
  std::vector<BodyId> ids;
  for (int i = 0; i < def.stones; ++i) {
    const Vec2 stone[] = {point(i, def.radius), point(i, outer), point(i + 1, outer),
                          point(i + 1, def.radius)};
    ids.push_back(addPrism(world, def, stone, Motion::kDynamic));
  }
  if (point(0, outer).y() < 1e-6) return ids;  // the stones stand on the ground
  for (const int end : {0, def.stones}) {
    const Vec2 in = point(end, def.radius), out = point(end, outer);
    const Vec2 springer[] = {in, out, {out.x(), 0}, {in.x(), 0}};
    ids.push_back(addPrism(world, def, springer, Motion::kStatic));
  }
  return ids;
}

}  // namespace physics
