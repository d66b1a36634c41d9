// From files to the cases of the stability study.
#include "scenes/study/stability_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/read/settings_reader.h"
#include "scenes/study/stability_tables.h"
#include "scenes/study/study_files.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;
using physics::Field;
using physics::Unit;

constexpr const char* kVariantKey = "stability.variant";

// Errors in what a family says name its file, whichever case it is read for.
void place(Value& value, const std::string& path) {
  value.place.setting = fmt::format("{}:{}:{}", path, value.place.line, value.place.column);
  for (Value& item : value.items) place(item, path);
  for (Member& member : value.members) {
    member.place.setting = fmt::format("{}:{}:{}", path, member.place.line, member.place.column);
    place(member.value, path);
  }
}

StabilityFamily readFamily(const Member& table, const Context& context) {
  if (!table.value.isTable()) fail(context, table.place, "expected a table for each family");
  StabilityFamily family;
  family.name = table.key;
  TableReader reader(table.value, table.key, context);
  family.title = table.key;
  reader(Field{"title"}, family.title);
  reader(Field{"about"}, family.about);
  reader(Field{"methods"}, family.methods);
  for (const Member& member : table.value.members) {
    if (reader.knows(member.key)) continue;
    if (!member.value.isTable()) {
      fail(context, member.place,
           fmt::format("{}.{}: expected a table of a scene file, such as simulation = {{ ... }}",
                       table.key, member.key));
    }
    family.settings.members.push_back(member);
    place(family.settings.members.back().value, context.path);
  }
  return family;
}

void erase(Value& tree, const std::string& key) {
  std::erase_if(tree.members, [&](const Member& member) { return member.key == key; });
}

void applyVariant(Value& tree, const StabilityTables& tables, const std::string& name) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < tables.variants.size(); ++i) {
    const StabilityVariant& variant = tables.variants[i];
    words.push_back(variant.name);
    if (variant.name != name) continue;
    const Value table = tree.find("variant")->items[i];  // a copy: the tree is about to change
    for (const std::string& set : variant.set) applyOverride(tree, set);
    if (const Value* expect = table.find("expect")) {
      erase(tree, "expect");
      tree.members.push_back({"expect", expect->place, *expect});
    }
    return;
  }
  throw InputError(fmt::format("--set {}={}: no such [[variant]]{}", kVariantKey, name,
                               didYouMean(name, words)));
}

// Takes "stability.variant=NAME" out of the overrides.
std::string takeVariant(std::vector<std::string>& overrides) {
  std::string name;
  std::erase_if(overrides, [&](const std::string& setting) {
    if (!setting.starts_with(std::string(kVariantKey) + "=")) return false;
    name = setting.substr(setting.find('=') + 1);
    return true;
  });
  return name;
}

std::vector<StudyMethod> chooseMethods(const StabilityTables& tables, const StabilityFamily& family,
                                       const Context& context) {
  const std::vector<StudyMethod> known = studyMethods();
  const bool own = !tables.methods.empty();
  std::vector<StudyMethod> methods;
  for (const std::string& name : own ? tables.methods : family.methods) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const StudyMethod& method) {
      return method.name == name && method.peer.empty();
    });
    if (found != known.end()) {
      methods.push_back(*found);
      continue;
    }
    std::vector<std::string> words;
    for (const StudyMethod& method : known) {
      if (method.peer.empty()) words.push_back(method.name);
    }
    const std::string message =
        fmt::format("methods: no method of ours '{}'{}", name, didYouMean(name, words));
    if (own) fail(context, tables.methodsPlace, "stability." + message);
    throw InputError(fmt::format("stability_families.toml: {}: {}", family.name, message));
  }
  return methods;
}

// The value in the file is the level that the case states.
void findStated(const Value& tree, const StabilityTables& tables, const Context& context,
                StabilitySeverity& severity) {
  for (const std::string& key : severity.keys) {
    const Value* value = findValue(tree, key);
    if (value == nullptr || !value->isNumber()) {
      fail(context, tables.severityPlace,
           fmt::format("severity.set: expected a number at '{}' in this file or its family", key));
    }
    severity.stated = value->number;
  }
  const double place = severity.placeOf(severity.stated);
  if (place >= 0 && place <= 1) return;
  fail(context, tables.severityPlace,
       fmt::format("severity.set: expected the stated level between 'from' and 'to', got {} = {}",
                   severity.keys.back(), severity.stated));
}

// "arch.falls" and "my/arch.toml.falls": the file and the variant.
std::pair<std::string, std::string> splitVariant(const std::string& word) {
  const std::size_t dot = word.rfind('.'), slash = word.rfind('/');
  const bool hasDot = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  if (!hasDot || word.substr(dot) == ".toml") return {word, ""};
  return {word.substr(0, dot), word.substr(dot + 1)};
}

// The file as it is. The tree gets its family's settings.
StabilityCase readBase(Value& tree, const StabilityTables& tables, const Context& context,
                       const std::string& text) {
  StabilityCase base;
  base.path = context.path;
  base.text = text;
  base.name = fs::path(base.path).stem().string();
  base.family = findFamily(stabilityFamilies(), tables, context);
  base.about = tables.about;
  base.quick = tables.quick;
  base.methods = chooseMethods(tables, base.family, context);
  base.severity = tables.severity;
  applyStability(tree, base.path, {});
  if (base.severity) findStated(tree, tables, context, *base.severity);
  const Value* title = tree.find("title");
  base.title = title != nullptr && title->isString() ? title->text : base.name;
  return base;
}

StabilityCase variantOf(const StabilityCase& base, const StabilityVariant& variant) {
  StabilityCase result = base;
  result.variant = variant.name;
  result.name += "." + variant.name;
  result.title += ": " + variant.name;
  if (!variant.about.empty()) result.about = variant.about;
  result.severity.reset();
  return result;
}

// Rounded to a thousandth of the range, so that a level can be read and typed.
double roundLevel(double level, const StabilitySeverity& severity) {
  constexpr int kDigits = 3;
  const double from = severity.from, to = severity.to;
  if (severity.scale == StabilitySeverity::Scale::kInteger) return std::round(level);
  if (severity.scale == StabilitySeverity::Scale::kLog) {
    const int more = static_cast<int>(std::ceil(-std::log10(std::abs(std::log(to / from)))));
    return std::stod(fmt::format("{:.{}e}", level, kDigits - 1 + std::max(0, more)));
  }
  const int decimals = kDigits - static_cast<int>(std::floor(std::log10(std::abs(to - from))));
  if (decimals >= 0) return std::stod(fmt::format("{:.{}f}", level, decimals));
  const double unit = std::pow(10, -decimals);
  return unit * std::round(level / unit);
}

}  // namespace

double StabilitySeverity::placeOf(double level) const {
  if (scale != Scale::kLog) return (level - from) / (to - from);
  return level / from > 0 ? std::log(level / from) / std::log(to / from) : -1;
}

double StabilitySeverity::levelAt(double place) const {
  if (place <= 0) return from;
  if (place >= 1) return to;
  const double level =
      scale == Scale::kLog ? from * std::pow(to / from, place) : from + place * (to - from);
  return roundLevel(level, *this);
}

std::vector<std::string> StabilitySeverity::overrides(double level) const {
  std::vector<std::string> result;
  for (const std::string& key : keys) result.push_back(fmt::format("{}={}", key, level));
  return result;
}

std::vector<StabilityFamily> stabilityFamilies() {
  const std::string path = (fs::path(studyFolder()) / "stability_families.toml").string();
  const Value tree = parseToml(readStudyText(path), path);
  const Context context{path, nullptr};
  std::vector<StabilityFamily> families;
  for (const Member& table : tree.members) families.push_back(readFamily(table, context));
  return families;
}

std::vector<std::string> applyStability(Value& tree, const std::string& path,
                                        std::span<const std::string> overrides) {
  std::vector<std::string> left(overrides.begin(), overrides.end());
  if (tree.find("stability") == nullptr) return left;
  const Context context{path, nullptr};
  const StabilityTables tables = readStabilityTables(tree, context);
  applyFamily(tree, findFamily(stabilityFamilies(), tables, context), tables, context);
  if (const std::string variant = takeVariant(left); !variant.empty()) {
    applyVariant(tree, tables, variant);
  }
  for (const char* word : {"stability", "severity", "variant"}) erase(tree, word);
  return left;
}

std::vector<StabilityCase> readStabilityCases(const std::string& word) {
  const auto [file, variant] = splitVariant(word);
  const std::string path = studyPath(file, "stability");
  const std::string text = readStudyText(path);
  Value tree = parseToml(text, path);
  const Context context{path, nullptr};
  if (tree.find("stability") == nullptr) {
    throw InputError(fmt::format("{}:1:1: expected a table [stability]", path));
  }
  const StabilityTables tables = readStabilityTables(tree, context);
  const StabilityCase base = readBase(tree, tables, context, text);
  std::vector<StabilityCase> cases;
  if (variant.empty()) cases.push_back(base);
  for (const StabilityVariant& other : tables.variants) {
    if (variant.empty() || variant == other.name) cases.push_back(variantOf(base, other));
  }
  if (cases.empty()) throw InputError(fmt::format("{}: no variant '{}'", path, variant));
  for (StabilityCase& study : cases) {
    study.duration = stabilityScene(study, {}).duration;  // and a mistake is told now
  }
  return cases;
}

std::vector<std::string> stabilityFiles() { return studyFiles("stability"); }

Scene stabilityScene(const StabilityCase& study, std::span<const std::string> more) {
  std::vector<std::string> set;
  if (!study.variant.empty()) set.push_back(std::string(kVariantKey) + "=" + study.variant);
  set.insert(set.end(), more.begin(), more.end());
  return readScene(study.path, set);
}

}  // namespace scenes
