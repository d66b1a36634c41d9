// [light] [[label]] and the background: what pictures look like.
#include <fmt/format.h>

#include "scenes/read/read_body.h"
#include "scenes/read/settings_reader.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

void readLight(TableReader& reader, LightDef& light) {
  reader(Field{"shadows"}, light.shadows);
  reader(Field{"direction", Unit::kDirection}, light.direction);
  reader(Field{"softness", Unit::kNone, false, 0, 30}, light.softnessDegrees);
  readColor(reader, light.color);
  if (light.direction && light.direction->y() > -0.05 * light.direction->norm()) {
    reader.failAt("direction", "expected light that comes from above: y below 0");
  }
}

void readLabel(TableReader& reader, Scene& scene) {
  LabelDef label;
  reader(Field{"text", Unit::kNone, true}, label.text);
  reader(Field{"body"}, label.body);
  reader(Field{"at", Unit::kPoint}, label.at);
  reader(Field{"from", Unit::kNone, false, 0}, label.from);
  reader(Field{"to", Unit::kNone, false, 0}, label.to);
  reader(Field{"size", Unit::kNone, false, 4, 200}, label.size);
  if (!reader.has("body") && !reader.has("at")) reader.failHere("expected 'body', 'at' or both");
  if (label.from && label.to && *label.from > *label.to) {
    reader.failAt("from", fmt::format("expected a time <= {} s, where it ends", *label.to));
  }
  scene.labels.push_back(std::move(label));
}

}  // namespace

void readLooks(TableReader& root, Scene& scene) {
  readTable(root, "light", [&](TableReader& reader) { readLight(reader, scene.light); });
  readTables(root, "label", [&](TableReader& reader) { readLabel(reader, scene); });
  if (const Value* value = root.take("background")) {
    scene.background =
        colorOf(*value, root.spot(Field{"background", Unit::kNone, false, 0, 1}), true);
  }
}

void readValue(const Value& value, const Spot& spot, Patterns& out) {
  out.any.clear();
  if (value.isString()) {
    out.any = {value.text};
    return;
  }
  if (!value.isArray() || value.items.empty()) {
    failExpected(spot, value, "a name, a pattern such as 'stack.*', or several of them");
  }
  for (const Value& item : value.items) {
    readValue(item, spot, out.any.emplace_back());
  }
}

}  // namespace scenes
