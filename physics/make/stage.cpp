// Fixed boxes for others to fall into and down.
#include "physics/make/stage.h"

#include <cmath>

namespace physics {
namespace {

BodyId addFixed(World& world, const Box& box, const Pose& pose,
                const std::optional<Friction>& friction) {
  BodyDef body;
  body.shape = box;
  body.pose = pose;
  body.motion = Motion::kStatic;
  body.friction = friction;
  return world.add(body);
}

}  // namespace

std::vector<BodyId> add(World& world, const BowlDef& def) {
  const double sine = std::sin(def.slope), cosine = std::cos(def.slope);
  const double along = def.height / sine;                      // m, up a wall
  const double rim = def.radius + def.height * cosine / sine;  // m, from the middle to a wall's top
  const double side = 2 * rim * std::tan(M_PI / def.sides);    // m, a wall's width at its top
  std::vector<BodyId> ids;
  const double floor = 2 * def.radius / std::cos(M_PI / def.sides);
  ids.push_back(addFixed(world, Box{Vec3(floor, def.thickness, floor)},
                         def.place({Vec3(0, 0.5 * def.thickness, 0), Quat::Identity()}),
                         def.friction));
  for (int i = 0; i < def.sides; ++i) {
    // Local axes of a wall at angle 0: y up along it, x its outer normal, z across.
    const Quat turn(Eigen::AngleAxisd(2 * M_PI * i / def.sides, Vec3::UnitY()));
    const Quat slope(Eigen::AngleAxisd(def.slope - M_PI / 2, Vec3::UnitZ()));
    const Vec3 middle(def.radius + 0.5 * along * cosine + 0.5 * def.thickness * sine,
                      def.thickness + 0.5 * along * sine - 0.5 * def.thickness * cosine, 0);
    const Box wall{Vec3(def.thickness, along, side)};
    ids.push_back(addFixed(world, wall, def.place({turn * middle, turn * slope}), def.friction));
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
    ids.push_back(
        addFixed(world, Box{Vec3(tread, height, def.width)}, def.place(pose), def.friction));
    x += tread;
  }
  return ids;
}

}  // namespace physics
