// [[body]]: one body with its shape, mass, pose, velocities and colour.
#include "scenes/read/read_body.h"

#include <fmt/format.h>

#include "physics/make/matter.h"
#include "scenes/read/read_parts.h"
#include "scenes/read/read_shape.h"
#include "scenes/read/recipe.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Motion;
using physics::Unit;
using physics::Vec3;

Motion readMotion(TableReader& reader, const physics::Shape& shape) {
  const bool isGround = physics::isGroundOnly(shape);
  bool fixed = isGround, kinematic = false;
  reader(Field{"fixed"}, fixed);
  reader(Field{"kinematic"}, kinematic);
  if (fixed && kinematic) reader.failAt("kinematic", "expected 'fixed' or 'kinematic', not both");
  if (isGround && !fixed) {
    const bool isPlane = std::holds_alternative<physics::Plane>(shape);
    reader.failAt("fixed", isPlane ? "expected true: a plane does not move"
                                   : "expected true: ground of triangles does not move");
  }
  return fixed ? Motion::kStatic : kinematic ? Motion::kKinematic : Motion::kDynamic;
}

void readInertia(TableReader& reader, physics::BodyDef& def) {
  reader(Field{"inertia", Unit::kNone, false, kPositive}, def.inertia);
  if (!def.inertia) return;
  const Vec3& inertia = *def.inertia;
  if (inertia.maxCoeff() > (inertia.sum() - inertia.maxCoeff()) * (1 + 1e-9)) {
    reader.failAt("inertia", fmt::format("expected moments of which none exceeds the sum of the "
                                         "other two, got [{}, {}, {}]",
                                         inertia.x(), inertia.y(), inertia.z()));
  }
}

physics::Matter readMatter(TableReader& reader) {
  physics::Matter matter;
  physics::Matter::fields(reader, matter);
  reader.atMostOne("mass", "density");
  return matter;
}

void takeMass(const TableReader& reader, const physics::Matter& matter, physics::BodyDef& def) {
  if (def.motion != Motion::kDynamic && !matter.mass && !matter.density) return;
  try {
    def.mass = physics::massOf(def.shape, matter);
  } catch (const std::invalid_argument& error) {
    reader.failAt("density", error.what());
  }
}

void readVelocity(TableReader& reader, physics::BodyDef& def) {
  reader(Field{"velocity"}, def.velocity.v);
  reader(Field{"angular_velocity"}, def.velocity.w);
  for (const char* key : {"velocity", "angular_velocity"}) {
    if (def.motion == Motion::kStatic && reader.has(key)) {
      reader.failAt(key, "expected none: the body is fixed (kinematic = true moves it)");
    }
  }
}

// Of one shape or several: the shape in its body frame, and where the file has that frame.
struct ReadShape {
  PlacedShape placed;
  std::optional<double> mass;                        // of several: the sum
  std::vector<std::optional<render::Color>> colors;  // of several
};

// `inertia` about centre_of_mass along inertia_axes, of a body of several shapes.
std::optional<StatedInertia> readStated(TableReader& reader, const physics::Matter& matter,
                                        const std::optional<Vec3>& inertia) {
  StatedInertia stated;
  reader(Field{"centre_of_mass", Unit::kBodyPoint}, stated.frame.x);
  reader(Field{"inertia_axes"}, stated.frame.q);
  for (const char* key : {"centre_of_mass", "inertia_axes"}) {
    const bool whole = reader.has("shapes") && inertia && matter.mass;
    if (reader.has(key) && !whole) {
      reader.failAt(key, "expected 'shapes', 'mass' and 'inertia' beside it");
    }
  }
  if (!reader.has("shapes") || !inertia) return std::nullopt;
  if (!matter.mass) reader.failAt("inertia", "expected 'mass' beside it");
  stated.mass = *matter.mass;
  stated.moments = *inertia;
  return stated;
}

ReadShape readShapes(TableReader& reader, const physics::Matter& matter,
                     const std::optional<Vec3>& inertia) {
  const std::optional<StatedInertia> stated = readStated(reader, matter, inertia);
  reader.exactlyOne("shape", "shapes");
  if (!reader.has("shapes")) return {readShapeOf(reader), {}, {}};
  const Value* value = reader.take("shapes");
  const ReadParts parts = readParts(*value, reader.spot(Field{"shapes"}), matter, stated);
  return {{parts.made.compound, parts.made.toParts}, parts.made.mass, parts.colors};
}

}  // namespace

physics::Pose readPose(TableReader& reader) {
  physics::Pose pose;
  reader(Field{"position", Unit::kPoint}, pose.x);
  reader(Field{"quaternion"}, pose.q);
  reader(Field{"rotation"}, pose.q);
  reader.atMostOne("quaternion", "rotation");
  return pose;
}

void readBody(TableReader& reader, Recipe& recipe) {
  const std::string name =
      readName(reader, fmt::format("body.{}", recipe.trial().world.bodyCount() - 1));
  physics::BodyDef def;
  reader(Field{"substeps", Unit::kNone, false, 1, 1e6}, def.substeps);
  physics::Matter matter = readMatter(reader);
  def.friction = matter.friction;
  def.restitution = matter.restitution;
  readInertia(reader, def);
  const ReadShape shape = readShapes(reader, matter, def.inertia);
  if (shape.mass && !matter.mass) matter.mass = shape.mass;
  def.shape = shape.placed.shape;
  def.pose = physics::placed(readPose(reader), shape.placed.toFile);
  def.pose.q.normalize();
  def.motion = readMotion(reader, def.shape);
  takeMass(reader, matter, def);
  readVelocity(reader, def);
  std::optional<render::Color> color;
  readColor(reader, color);
  if (recipe.trial().ids.contains(name)) {
    reader.failAt("name", fmt::format("expected a new name, '{}' is a body already", name));
  }
  recipe.add(reader, [=](Built& built) {
    const physics::BodyId id = built.world.add(def);
    const bool moves = def.motion == Motion::kDynamic;
    const render::Color own =
        moves ? familyColor(Pattern::kSingle, built.families++, 0) : fixedColor();
    built.name(id, name, color.value_or(own));
    built.place(id, shape.placed.toFile);
    for (std::size_t i = 0; i < shape.colors.size(); ++i) {
      built.appearance.parts[id][i].color = shape.colors[i];
    }
  });
}

void readColor(TableReader& reader, std::optional<render::Color>& color) {
  const Value* value = reader.take("color");
  if (value != nullptr)
    color = colorOf(*value, reader.spot(Field{"color", Unit::kNone, false, 0, 1}));
}

render::Color colorOf(const Value& value, const Spot& spot, bool orTransparent) {
  const std::size_t count = value.items.size();
  if (value.isArray() && (count == 3 || count == 4)) {
    std::vector<double> parts;
    readValue(value, spot, parts);
    render::Color color(0, 0, 0, 1);
    for (std::size_t i = 0; i < count; ++i) {
      color[static_cast<Eigen::Index>(i)] = static_cast<float>(parts[i]);
    }
    return color;
  }
  std::vector<std::string> names = colorNames();
  if (orTransparent) {
    if (value.isString() && value.text == "transparent") return {1, 1, 1, 0};
    names.emplace_back("transparent");
  }
  const auto color = value.isString() ? namedColor(value.text) : std::nullopt;
  if (color) return *color;
  failExpected(spot, value,
               std::string("[r, g, b] or [r, g, b, a] in [0, 1], '#rrggbb', '#rrggbbaa'") +
                   (orTransparent ? ", 'transparent'" : "") + " or the name of a colour" +
                   (value.isString() ? didYouMean(value.text, names) : ""));
}

}  // namespace scenes
