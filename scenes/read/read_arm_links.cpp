// The links of an [[arm]]: alike, or one table for each.
#include <fmt/format.h>

#include "physics/make/placement.h"
#include "scenes/read/read_arm.h"

namespace scenes {
namespace {

using physics::ArmLinkDef;
using physics::Field;
using physics::Unit;
using physics::Vec3;

// What a link can be told, in its own table or for all links in the arm's.
struct LinkWords {
  std::optional<double> length;
  double mass = 1, radius = 0.03;
  std::optional<Vec3> inertia, hinge;
  std::optional<double> centre;
  std::array<double, 2> range = ArmLinkDef{}.range;
  double bend = ArmLinkDef{}.bend;
  double angle = 0;
};

void readLink(TableReader& reader, LinkWords& words) {
  reader(Field{"length", Unit::kMetre, !words.length, kPositive}, words.length);
  reader(Field{"mass", Unit::kNone, false, kPositive}, words.mass);
  reader(Field{"radius", Unit::kMetre, false, kPositive}, words.radius);
  reader(Field{"inertia", Unit::kNone, false, 0}, words.inertia);
  reader(Field{"centre", Unit::kMetre}, words.centre);
  reader(Field{"hinge", Unit::kDirection}, words.hinge);
  reader(Field{"limits_degrees", Unit::kDegrees}, words.range);
  reader(Field{"bend_degrees", Unit::kDegrees, false, 0, 180}, words.bend);
  if (reader.has("limits_degrees") && !words.hinge) {
    reader.failAt("limits_degrees", "expected a 'hinge' as well; a ball joint has 'bend_degrees'");
  }
  if (reader.has("bend_degrees") && words.hinge) {
    reader.failAt("bend_degrees", "expected none: a hinge has 'limits_degrees'");
  }
}

// From `radius` at the root to `tip_radius` at the tip.
void readTaper(TableReader& reader, std::vector<LinkWords>& links) {
  double tip = 0;
  reader(Field{"tip_radius", Unit::kMetre, false, kPositive}, tip);
  if (!reader.has("tip_radius")) return;
  for (size_t k = 1; k < links.size(); ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(links.size() - 1);
    links[k].radius += part * (tip - links[k].radius);
  }
}

// A joint angle for each link, or one for all; `absolute`: from the base, not from the parent.
void readAngles(TableReader& reader, std::vector<LinkWords>& links) {
  reader.atMostOne("angles_degrees", "absolute_degrees");
  for (const char* key : {"angles_degrees", "absolute_degrees"}) {
    const Value* value = reader.take(key);
    if (value == nullptr) continue;
    std::vector<double> angles(links.size());
    const Spot spot = reader.spot(Field{key, Unit::kDegrees});
    if (value->isArray()) {
      readValue(*value, spot, angles);
    } else {
      readValue(*value, spot, angles[0]);
      angles.assign(links.size(), angles[0]);
    }
    if (angles.size() != links.size()) {
      reader.failAt(key, fmt::format("expected a number or {} numbers, one per link, got {}",
                                     links.size(), angles.size()));
    }
    const bool absolute = std::string(key) == "absolute_degrees";
    for (size_t k = 0; k < links.size(); ++k) {
      links[k].angle = absolute && k > 0 ? angles[k] - angles[k - 1] : angles[k];
    }
  }
}

std::vector<LinkWords> readWords(TableReader& reader) {
  LinkWords all;
  all.length = 0;  // not asked for yet
  const Value* list = reader.take("links");
  if (list == nullptr) {
    int count = 0;
    reader(Field{"count", Unit::kNone, true, 1, 10000}, count);
    all.length.reset();
    readLink(reader, all);
    std::vector<LinkWords> links(static_cast<size_t>(count), all);
    readTaper(reader, links);
    return links;
  }
  reader.atMostOne("count", "links");
  reader.atMostOne("length", "links");
  readLink(reader, all);
  all.length.reset();
  if (!list->isArray() || list->items.empty()) {
    failExpected(reader.spot({"links"}), *list, "an array of tables { length, ... }");
  }
  std::vector<LinkWords> links;
  for (const Value& item : list->items) {
    if (!item.isTable()) failExpected(reader.spot({"links"}), item, "a table { length, ... }");
    TableReader own(item, "arm.links", reader.context());
    readLink(own, links.emplace_back(all));
    own.finish();
  }
  return links;
}

}  // namespace

void readLinks(TableReader& reader, physics::ArmDef& def) {
  Vec3 direction = Vec3::UnitX(), axis = Vec3::UnitZ();
  reader(Field{"direction", Unit::kDirection}, direction);
  reader(Field{"axis", Unit::kDirection}, axis);
  std::vector<LinkWords> links = readWords(reader);
  readAngles(reader, links);
  for (const LinkWords& words : links) {
    ArmLinkDef link;
    link.length = *words.length * direction.normalized();
    link.mass = words.mass;
    link.radius = words.radius;
    link.inertia = words.inertia;
    if (words.centre) link.centre = *words.centre * direction.normalized();
    link.hinge = words.hinge.has_value();
    link.axis = words.hinge.value_or(axis);
    link.angle = words.angle;
    link.range = words.range;
    link.bend = words.bend;
    def.links.push_back(link);
  }
}

}  // namespace scenes
