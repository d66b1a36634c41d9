// Piles, from below.
#include "physics/make/stack.h"

#include <algorithm>

namespace physics {
namespace {

Vec3 extents(const Shape& shape) {
  Vec3 size;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = Vec3::Unit(i);
    size[i] = reach(shape, Quat::Identity(), axis) + reach(shape, Quat::Identity(), -axis);
  }
  return size;
}

// Bodies in the order of latticePoses: x runs first, then z, then y.
void joinNeighbours(World& world, const std::array<int, 3>& counts,
                    const std::vector<BodyId>& ids) {
  const int strides[] = {1, counts[0] * counts[2], counts[0]};
  for (int i = 0; i < static_cast<int>(ids.size()); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (i / strides[axis] % counts[axis] == 0) continue;
      BallSocketDef joint;
      joint.bodies = {ids[i - strides[axis]], ids[i]};
      const std::vector<Pose>& pose = world.bodies().pose;
      joint.at = 0.5 * (pose[joint.bodies[0]].x + pose[joint.bodies[1]].x);
      world.add(joint);
    }
  }
}

}  // namespace

std::vector<BodyId> add(World& world, const StackDef& def) {
  Random random(def.seed);
  std::vector<BodyId> ids;
  const double below = reach(def.shape, Quat::Identity(), -Vec3::UnitY());
  const double above = reach(def.shape, Quat::Identity(), Vec3::UnitY());
  for (int i = 0; i < def.count; ++i) {
    Pose pose;
    pose.x.y() = below + i * (below + above + def.gap);
    if (def.jitter > 0) {
      pose.x.x() = random.uniform(-def.jitter, def.jitter);
      pose.x.z() = random.uniform(-def.jitter, def.jitter);
    }
    ids.push_back(world.add(bodyOf(def.shape, def.matter, def.place(pose))));
  }
  return ids;
}

std::vector<BodyId> add(World& world, const PyramidDef& def) {
  requireCount(0.5 * def.base * (def.base + 1.0));
  std::vector<BodyId> ids;
  const double pitch = def.size.x() + def.gap;
  for (int row = 0; row < def.base; ++row) {
    const int count = def.base - row;
    for (int i = 0; i < count; ++i) {
      Pose pose;
      pose.x = Vec3((i - 0.5 * (count - 1)) * pitch, (row + 0.5) * def.size.y(), 0);
      ids.push_back(world.add(bodyOf(Box{def.size}, def.matter, def.place(pose))));
    }
  }
  return ids;
}

std::vector<BodyId> add(World& world, const WallDef& def) {
  requireCount((def.columns + 1.0) * def.rows);
  std::vector<BodyId> ids;
  const double pitch = def.size.x() + def.gap, left = -0.5 * def.columns * pitch;
  const double halfLength = 0.5 * (def.size.x() - def.gap);
  require(halfLength > 0, "expected a gap smaller than a brick is long");
  const auto lay = [&](double x, double length, int row) {
    Pose pose;
    pose.x = Vec3(x, (row + 0.5) * def.size.y(), 0);
    const Box brick{Vec3(length, def.size.y(), def.size.z())};
    Matter matter = def.matter;
    if (matter.mass) *matter.mass *= length / def.size.x();
    ids.push_back(world.add(bodyOf(brick, matter, def.place(pose))));
  };
  for (int row = 0; row < def.rows; ++row) {
    const bool shifted = row % 2 == 1;
    const double first = left + (shifted ? pitch : 0.5 * pitch);
    if (shifted) lay(left + 0.5 * (def.gap + halfLength), halfLength, row);
    for (int i = 0; i < def.columns - (shifted ? 1 : 0); ++i) {
      lay(first + i * pitch, def.size.x(), row);
    }
    if (shifted) lay(-left - 0.5 * (def.gap + halfLength), halfLength, row);
  }
  return ids;
}

std::vector<BodyId> add(World& world, const GridDef& def) {
  require(!def.shapes.empty(), "expected at least one shape");
  Vec3 spacing = Vec3::Zero();
  for (const Shape& shape : def.shapes) spacing = spacing.cwiseMax(extents(shape));
  std::vector<BodyId> ids;
  for (const Pose& pose : latticePoses(def.lattice, spacing, def.seed)) {
    const Shape& shape = def.shapes[ids.size() % def.shapes.size()];
    BodyDef body = bodyOf(shape, def.matter, def.place(pose));
    body.velocity = def.velocity;
    ids.push_back(world.add(body));
  }
  if (def.joined) joinNeighbours(world, def.lattice.counts, ids);
  return ids;
}

}  // namespace physics
