// The parts of a body: each a shape with its pose in the body's frame, its mass and its colour.
#include "scenes/read/read_parts.h"

#include "scenes/read/read_body.h"
#include "scenes/read/read_shape.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

struct ReadPart {
  physics::PartDef part;
  std::optional<render::Color> color;
};

ReadPart readPart(const Value& value, const Spot& spot, const physics::Matter& matter) {
  if (!value.isTable()) {
    failExpected(spot, value, "a part such as { shape = { sphere = { radius = 1 } } }");
  }
  TableReader reader(value, spot.key, spot.context);
  const PlacedShape placed = readShapeOf(reader);
  const physics::Pose pose = readPose(reader);
  physics::Matter own{{}, matter.density, {}, {}};
  reader(Field{"mass", Unit::kNone, false, kPositive}, own.mass);
  reader(Field{"density", Unit::kNone, false, kPositive}, own.density);
  reader.atMostOne("mass", "density");
  ReadPart read;
  readColor(reader, read.color);
  reader.finish();
  const double volume = physics::massProperties(placed.shape).volume;
  if (!(volume > 0)) {
    reader.failAt("shape",
                  "expected a part with a volume: a box, sphere, capsule, cylinder or "
                  "convex");
  }
  read.part = {placed.shape, physics::placed(pose, placed.toFile),
               physics::massOf(placed.shape, own)};
  return read;
}

}  // namespace

ReadParts readParts(const Value& value, const Spot& spot, const physics::Matter& matter,
                    const std::optional<StatedInertia>& stated) {
  if (!value.isArray() || value.items.empty()) {
    failExpected(spot, value,
                 "an array of parts such as [{ shape = { sphere = { radius = 1 } } }]");
  }
  ReadParts read;
  std::vector<physics::PartDef> parts;
  for (const Value& item : value.items) {
    const ReadPart part = readPart(item, spot, matter);
    parts.push_back(part.part);
    read.colors.push_back(part.color);
  }
  read.made = stated ? physics::makeCompound(parts, stated->frame, stated->moments / stated->mass)
                     : physics::makeCompound(parts);
  return read;
}

}  // namespace scenes
