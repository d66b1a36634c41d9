// The words that a reading asked for, and how units and ranges are written.
#include "scenes/read/glossary.h"

#include <algorithm>
#include <cmath>

#include "scenes/joined.h"
#include "scenes/read/read_value.h"

namespace scenes {

using physics::Unit;

namespace {

// A shape, a rotation and a friction are the same wherever they stand.
std::string sharedName(const std::string& table) {
  for (const char* word :
       {".rotation", ".quaternion", ".reference", ".orientation", ".target", ".inertia_axes"}) {
    if (table.ends_with(word)) return "rotation";
  }
  for (const char* parent : {".shape.", ".shapes."}) {
    if (table.find(parent) == std::string::npos) continue;
    return fmt::format("shape{}", table.substr(table.rfind('.')));
  }
  for (const char* word : {"friction", "over_time"}) {
    if (table.ends_with(std::string(".") + word)) return word;
  }
  return table;
}

}  // namespace

void Glossary::note(const std::string& table, GlossaryKey key) {
  std::vector<GlossaryKey>& keys = tables[sharedName(table)];
  const auto known = std::find_if(keys.begin(), keys.end(),
                                  [&](const GlossaryKey& k) { return k.name == key.name; });
  if (known == keys.end()) {
    keys.push_back(std::move(key));
  } else if (known->type.empty() && !key.type.empty()) {
    *known = std::move(key);
  } else if (!key.type.empty()) {
    if (known->standard != key.standard) known->standard.clear();
    known->required = known->required && key.required;
  }
}

void Glossary::noteTable(const std::string& table) { tables[sharedName(table)]; }

const Meaning* findMeaning(const std::string& table, const std::string& key) {
  const std::string path = table.empty() ? key : table + "." + key, any = "*." + key;
  for (const std::string& wanted : {path, any}) {
    for (const auto& meanings : {sharedMeanings(), ownMeanings()}) {
      for (const Meaning& meaning : meanings) {
        if (wanted == meaning.path) return &meaning;
      }
    }
    if (table.empty()) break;
  }
  return nullptr;
}

std::string unitWord(Unit unit) {
  switch (unit) {
    case Unit::kPoint:
    case Unit::kBodyPoint:
    case Unit::kMetre:
      return "m";
    case Unit::kDegrees:
      return "degrees";
    case Unit::kNewtonPerMetre:
      return "N/m";
    case Unit::kNewtonSecondPerMetre:
      return "N s/m";
    case Unit::kNewtonMetre:
      return "N m";
    case Unit::kNewtonMetrePerRadian:
      return "N m/rad";
    case Unit::kNewtonMetreSecond:
      return "N m s";
    case Unit::kRadianPerSecond:
      return "rad/s";
    case Unit::kNone:
    case Unit::kBody:
    case Unit::kDirection:
      break;
  }
  return "";
}

std::string rangeWord(const physics::Field& field) {
  const bool low = std::isfinite(field.low), high = std::isfinite(field.high);
  const std::string above = field.low == kPositive ? "> 0"
                            : low                  ? fmt::format(">= {}", field.low)
                                                   : "";
  if (low && high && field.low != kPositive)
    return fmt::format("in [{}, {}]", field.low, field.high);
  if (high) return fmt::format("{}{}<= {}", above, above.empty() ? "" : " and ", field.high);
  return above;
}

std::string choiceWord(std::span<const char* const> choices) { return joined(choices, " | "); }

}  // namespace scenes
