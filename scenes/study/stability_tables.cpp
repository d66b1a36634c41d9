// Reads the tables that make a scene file a case of the stability study.
#include "scenes/study/stability_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/read/settings_reader.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

void readHead(TableReader& reader, StabilityTables& tables) {
  reader(Field{"family", Unit::kNone, true}, tables.family);
  tables.familyPlace = reader.table().find("family")->place;
  reader(Field{"about", Unit::kNone, true}, tables.about);
  reader(Field{"methods"}, tables.methods);
  if (reader.has("methods")) tables.methodsPlace = reader.table().find("methods")->place;
  reader(Field{"about_settings"}, tables.aboutSettings);
  reader(Field{"quick"}, tables.quick);
}

// One key, or several.
std::vector<std::string> readKeys(TableReader& reader) {
  const Value* value = reader.take("set");
  if (value == nullptr) reader.failHere("expected a value for 'set'");
  std::vector<std::string> keys;
  if (value->isString()) {
    keys.push_back(value->text);
  } else {
    readValue(*value, reader.spot({"set"}), keys);
  }
  if (keys.empty()) reader.failAt("set", "expected at least one key");
  for (const std::string& key : keys) {
    if (key.find('=') != std::string::npos) {
      reader.failAt("set",
                    fmt::format("expected a key as in --set, without a value, got '{}'", key));
    }
  }
  return keys;
}

void checkRange(const TableReader& reader, const StabilitySeverity& severity) {
  using Scale = StabilitySeverity::Scale;
  if (severity.from == severity.to) reader.failAt("to", "expected another value than 'from'");
  if (severity.scale == Scale::kLog && !(severity.from * severity.to > 0)) {
    reader.failAt("from", "expected 'from' and 'to' of the same sign for the scale 'log'");
  }
  for (const double end : {severity.from, severity.to}) {
    if (severity.scale == Scale::kInteger && end != std::round(end)) {
      reader.failAt("scale", fmt::format("expected whole 'from' and 'to', got {}", end));
    }
  }
}

void readSeverity(TableReader& reader, StabilityTables& tables) {
  StabilitySeverity severity;
  severity.keys = readKeys(reader);
  reader(Field{"from", Unit::kNone, true}, severity.from);
  reader(Field{"to", Unit::kNone, true}, severity.to);
  reader(Field{"scale"}, severity.scale);
  reader(Field{"label", Unit::kNone, true}, severity.label);
  reader(Field{"unit"}, severity.unit);
  reader(Field{"duration", Unit::kNone, false, kPositive}, severity.duration);
  checkRange(reader, severity);
  tables.severityPlace = reader.table().find("set")->place;
  tables.severity = std::move(severity);
}

void readVariant(TableReader& reader, StabilityTables& tables) {
  StabilityVariant variant;
  reader(Field{"name", Unit::kNone, true}, variant.name);
  reader(Field{"about"}, variant.about);
  reader(Field{"set"}, variant.set);
  reader.take("expect");  // read as the scene's
  if (variant.name.empty() || variant.name.find_first_of("./= ") != std::string::npos) {
    reader.failAt("name", "expected a word without '.', '/', '=' and spaces");
  }
  for (const StabilityVariant& other : tables.variants) {
    if (other.name == variant.name) reader.failAt("name", "expected a name of its own");
  }
  tables.variants.push_back(std::move(variant));
}

// "simulation.substeps" may be allowed as itself or as "substeps".
bool isAllowed(const StabilityTables& tables, const std::string& table, const std::string& key) {
  if (table == "simulation" && (key == "fps" || key == "seed")) return true;
  const std::string whole = table + "." + key;
  const auto allows = [&](const std::string& word) { return word == key || word == whole; };
  const auto& about = tables.aboutSettings;
  if (std::any_of(about.begin(), about.end(), allows)) return true;
  return tables.severity && std::find(tables.severity->keys.begin(), tables.severity->keys.end(),
                                      whole) != tables.severity->keys.end();
}

std::string notItsOwn(const std::string& setting, const StabilityTables& tables) {
  return fmt::format(
      "{}: expected none: how a case is solved is said by its family '{}' in "
      "stability_families.toml; a case that is about this setting names it in "
      "stability.about_settings",
      setting, tables.family);
}

void checkOwnSettings(const Value& tree, const StabilityFamily& family,
                      const StabilityTables& tables, const Context& context) {
  for (const Member& word : tree.members) {
    const Value* ofFamily = family.settings.find(word.key);
    for (const Member& member : word.value.members) {
      const bool isSolver = word.key == "simulation";
      const bool isFamily = ofFamily != nullptr && ofFamily->find(member.key) != nullptr;
      if (!(isSolver || isFamily) || isAllowed(tables, word.key, member.key)) continue;
      fail(context, member.place, notItsOwn(word.key + "." + member.key, tables));
    }
  }
  for (const StabilityVariant& variant : tables.variants) {
    for (const std::string& set : variant.set) {
      const std::string key = set.substr(0, set.find('='));
      if (!key.starts_with("simulation.") || isAllowed(tables, "simulation", key.substr(11))) {
        continue;
      }
      throw InputError(
          fmt::format("{}: variant '{}': {}", context.path, variant.name, notItsOwn(key, tables)));
    }
  }
}

}  // namespace

std::span<const char* const> names(StabilitySeverity::Scale) {
  static constexpr const char* kNames[] = {"log", "linear", "integer"};
  return kNames;
}

StabilityTables readStabilityTables(const Value& tree, const Context& context) {
  StabilityTables tables;
  TableReader root(tree, "", context);
  readTable(root, "stability", [&](TableReader& reader) { readHead(reader, tables); });
  readTable(root, "severity", [&](TableReader& reader) { readSeverity(reader, tables); });
  readTables(root, "variant", [&](TableReader& reader) { readVariant(reader, tables); });
  return tables;
}

StabilityFamily findFamily(const std::vector<StabilityFamily>& families,
                           const StabilityTables& tables, const Context& context) {
  std::vector<std::string> words;
  for (const StabilityFamily& family : families) {
    if (family.name == tables.family) return family;
    words.push_back(family.name);
  }
  fail(context, tables.familyPlace,
       fmt::format("stability.family: no family '{}' in stability_families.toml{}", tables.family,
                   didYouMean(tables.family, words)));
}

void applyFamily(Value& tree, const StabilityFamily& family, const StabilityTables& tables,
                 const Context& context) {
  checkOwnSettings(tree, family, tables, context);
  for (const Member& table : family.settings.members) {
    Value* own = tree.find(table.key);
    if (own == nullptr) {
      tree.members.push_back(table);
      continue;
    }
    for (const Member& member : table.value.members) {
      if (own->find(member.key) == nullptr) own->members.push_back(member);
    }
  }
}

}  // namespace scenes
