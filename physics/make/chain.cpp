// Links and planks, and the joints between them.
#include "physics/make/chain.h"

#include <cmath>

#include "physics/base/rotation.h"
#include "physics/make/hinge.h"

namespace physics {
namespace {

// Distance between the two joints of a link along y.
double pitchOf(const Shape& shape) {
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->length;
  return reach(shape, Quat::Identity(), Vec3::UnitY()) +
         reach(shape, Quat::Identity(), -Vec3::UnitY());
}

Shape linkOf(const ChainDef& def) {
  if (def.shape) return *def.shape;
  require(def.length || def.to,
          "expected 'shape', 'length' or 'to', which a link's length follows from");
  const double length = def.length ? *def.length : (*def.to - def.from).norm() / def.count;
  require(length > 0, "expected 'to' away from 'from'");
  return Capsule{def.radius, length};
}

Vec3 directionOf(const ChainDef& def, double length) {
  if (def.direction) return def.direction->normalized();
  if (!def.to) return -Vec3::UnitY();
  const Vec3 span = *def.to - def.from;
  require(std::abs(span.norm() - length) <= 1e-6 * length,
          "expected |to - from| = count * length of a link = " + std::to_string(length) +
              " m, got " + std::to_string(span.norm()) + " m");
  return span.normalized();
}

void join(World& world, const ChainDef& def, BodyId a, BodyId b, const Vec3& at) {
  if (def.joint == ChainJoint::kHinge) {
    HingeDef hinge;
    hinge.bodies = {a, b};
    hinge.at = at;
    hinge.axis = def.axis;
    hinge.form = def.form;
    hinge.collide = def.collide;
    hinge.tuning = def.tuning;
    add(world, hinge);
    return;
  }
  BallSocketDef ball;
  ball.bodies = {a, b};
  ball.at = at;
  ball.form = def.form;
  ball.collide = def.collide;
  ball.tuning = def.tuning;
  world.add(ball);
}

}  // namespace

std::vector<BodyId> add(World& world, const ChainDef& def) {
  const Shape link = linkOf(def);
  const double pitch = pitchOf(link);
  require(pitch > 0, "expected links with a length");
  const Vec3 direction = directionOf(def, pitch * def.count);
  const bool hanging = def.end && def.end->shape;
  std::vector<BodyId> ids;
  Vec3 joint = def.from;
  const auto append = [&](const Shape& shape, const Matter& matter, double length) {
    Pose pose{joint + 0.5 * length * direction, fromUp(direction)};
    const BodyId id = world.add(bodyOf(shape, matter, pose));
    if (!ids.empty() || def.fixedStart) {
      join(world, def, ids.empty() ? kWorldBody : ids.back(), id, joint);
    }
    ids.push_back(id);
    joint += length * direction;
  };
  for (int i = 0; i < def.count; ++i) {
    const bool heavy = def.end && !hanging && i == def.count - 1;
    Matter matter = heavy ? def.end->matter : def.matter;
    if (!matter.friction) matter.friction = def.matter.friction;
    append(link, matter, pitch);
  }
  if (hanging) {
    const Shape& shape = *def.end->shape;
    append(shape, def.end->matter, 2 * reach(shape, Quat::Identity(), -Vec3::UnitY()));
  }
  if (def.fixedEnd) join(world, def, ids.back(), kWorldBody, joint);
  return ids;
}

std::vector<BodyId> add(World& world, const BridgeDef& def) {
  const Vec3 span = def.to - def.from;
  const double length = span.norm();
  require(length > 0, "expected 'to' away from 'from'");
  const Vec3 along = span / length;
  const Vec3 across = along.cross(Vec3::UnitY());
  require(across.norm() > 1e-6, "expected a bridge that is not vertical");
  const Vec3 axis = across.normalized(), down = along.cross(axis);
  const double halfAngle = 2 * arcTangent(2 * def.sag, length);
  // The joint that lies `part` of the way along the arc.
  const auto jointAt = [&](int i) -> Vec3 {
    const double part = 2.0 * i / def.count - 1;
    if (def.sag < 1e-9 * length) return def.from + 0.5 * (1 + part) * span;
    const double radius = 0.5 * length / sineCosine(halfAngle).sine;
    const auto [sine, cosine] = sineCosine(part * halfAngle);
    return 0.5 * (def.from + def.to) + radius * sine * along +
           (def.sag - radius * (1 - cosine)) * down;
  };
  std::vector<BodyId> ids;
  const auto hingeAt = [&](int i, BodyId a, BodyId b) {
    HingeDef hinge;
    hinge.bodies = {a, b};
    hinge.at = jointAt(i);
    hinge.axis = axis;
    hinge.tuning = def.tuning;
    add(world, hinge);
  };
  for (int i = 0; i < def.count; ++i) {
    const Vec3 a = jointAt(i), b = jointAt(i + 1);
    const double plank = (b - a).norm() - def.gap;
    require(plank > 0, "expected a gap smaller than a plank is long");
    Mat3 frame;
    frame << (b - a).normalized(), axis.cross((b - a).normalized()), axis;
    const Pose pose{0.5 * (a + b), Quat(frame).normalized()};
    const Box box{Vec3(plank, def.thickness, def.width)};
    ids.push_back(world.add(bodyOf(box, def.matter, pose)));
    hingeAt(i, i == 0 ? kWorldBody : ids[i - 1], ids[i]);
  }
  hingeAt(def.count, ids.back(), kWorldBody);
  return ids;
}

}  // namespace physics
