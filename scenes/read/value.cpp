// Looking into Values, describing them, and changing them from the command line.
#include "scenes/read/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <span>

#include "scenes/joined.h"

namespace scenes {

Value::Value() = default;
Value::Value(const Value&) = default;
Value::Value(Value&&) noexcept = default;
Value& Value::operator=(const Value&) = default;
Value& Value::operator=(Value&&) noexcept = default;
Value::~Value() = default;

namespace {

size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

bool isIndex(const std::string& text) {
  return !text.empty() && text.size() < 8 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

// A word without quotes is taken for a string: shells eat quotes.
bool isBareWord(const std::string& text) {
  const auto inWord = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), inWord) && text != "true" && text != "false" &&
         text != "nan" && text != "inf";
}

void mark(Value& value, const std::string& setting) {
  value.place = {0, 0, setting};
  for (Value& item : value.items) mark(item, setting);
  for (Member& member : value.members) {
    member.place = value.place;
    mark(member.value, setting);
  }
}

Value parseSettingValue(const std::string& text, const std::string& setting) {
  Value value;
  if (isBareWord(text)) {
    value.kind = Value::Kind::kString;
    value.text = text;
  } else {
    try {
      Value table = parseToml("x = " + text, setting);
      if (table.members.size() != 1) throw InputError("more than one value");
      value = std::move(table.members[0].value);
    } catch (const InputError&) {
      throw InputError(fmt::format("{}: expected a TOML value after '=', got {}", setting,
                                   text.empty() ? "nothing" : text));
    }
  }
  mark(value, setting);
  return value;
}

std::vector<std::string> splitKey(const std::string& key, const std::string& setting) {
  std::vector<std::string> parts(1);
  for (const char c : key) {
    if (c == '.') {
      parts.emplace_back();
    } else if (!std::isspace(static_cast<unsigned char>(c))) {
      parts.back() += c;
    }
  }
  for (const std::string& part : parts) {
    if (part.empty()) throw InputError(setting + ": expected key=value with a dotted key");
  }
  return parts;
}

// The element that `parts` name from `k` on: an index, or a name, which may have dots. `k` moves to
// the last part that it takes. Past the end: none.
std::size_t indexOf(const Value& array, const std::vector<std::string>& parts, std::size_t& k) {
  if (isIndex(parts[k])) return std::stoul(parts[k]);
  for (std::size_t end = parts.size(); end > k; --end) {
    const std::string word = joined(std::span(parts).subspan(k, end - k), ".");
    for (std::size_t i = 0; i < array.items.size(); ++i) {
      const Value* name = array.items[i].find("name");
      if (name == nullptr || name->text != word) continue;
      k = end - 1;
      return i;
    }
  }
  return array.items.size();
}

Value& elementOf(Value& array, const std::vector<std::string>& parts, std::size_t& k,
                 const std::string& where, const std::string& setting) {
  const std::string& part = parts[k];
  const std::size_t index = indexOf(array, parts, k);
  if (index < array.items.size()) return array.items[index];
  if (isIndex(part)) {
    throw InputError(fmt::format("{}: {}: expected an index below {}, got {}", setting, where,
                                 array.items.size(), part));
  }
  std::vector<std::string> names;
  for (const Value& item : array.items) {
    if (const Value* name = item.find("name")) names.push_back(name->text);
  }
  throw InputError(fmt::format("{}: no {} '{}'{}", setting, where, part, didYouMean(part, names)));
}

Value& memberOf(Value& table, const std::string& part, const std::string& setting) {
  if (Value* found = table.find(part)) return *found;
  table.members.push_back({part, {0, 0, setting}, {}});
  table.members.back().value.place = {0, 0, setting};
  return table.members.back().value;
}

bool isTableOrTables(const Value& value) { return value.isTable() || isTables(value); }

// False: there is no table, or tables, at that key.
bool removeTable(Value& root, const std::vector<std::string>& parts, const std::string& setting) {
  Value* parent = &root;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    Value* next = parent->isArray() ? &elementOf(*parent, parts, i, parts[i - 1], setting)
                                    : parent->find(parts[i]);
    if (next == nullptr) return false;
    parent = next;
  }
  const auto isIt = [&](const Member& m) {
    return m.key == parts.back() && isTableOrTables(m.value);
  };
  return std::erase_if(parent->members, isIt) > 0;
}

}  // namespace

const Value* Value::find(const std::string& key) const {
  for (const Member& member : members) {
    if (member.key == key) return &member.value;
  }
  return nullptr;
}

Value* Value::find(const std::string& key) {
  for (Member& member : members) {
    if (member.key == key) return &member.value;
  }
  return nullptr;
}

bool isTables(const Value& value) {
  return value.isArray() && !value.items.empty() && value.items[0].isTable();
}

std::optional<Value> takeMember(Value& table, const std::string& key) {
  const auto found = std::find_if(table.members.begin(), table.members.end(),
                                  [&](const Member& member) { return member.key == key; });
  if (found == table.members.end()) return std::nullopt;
  Value value = std::move(found->value);
  table.members.erase(found);
  return value;
}

std::string describe(const Value& value) {
  switch (value.kind) {
    case Value::Kind::kTable:
      return "a table";
    case Value::Kind::kArray:
      return fmt::format("an array of {}", value.items.size());
    case Value::Kind::kBoolean:
      return value.boolean ? "true" : "false";
    case Value::Kind::kInteger:
      return fmt::format("{}", value.integer);
    case Value::Kind::kNumber:
      return fmt::format("{}", value.number);
    case Value::Kind::kString:
      return fmt::format("'{}'", value.text);
    case Value::Kind::kDate:
      return "a date";
  }
  return "nothing";
}

void applyOverride(Value& root, const std::string& keyAndValue) {
  const std::string setting = "--set " + keyAndValue;
  const size_t equals = keyAndValue.find('=');
  if (equals == std::string::npos) throw InputError(setting + ": expected key=value");
  std::string text = keyAndValue.substr(equals + 1);
  const auto isSpace = [](unsigned char c) { return std::isspace(c); };
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), isSpace));
  const std::vector<std::string> parts = splitKey(keyAndValue.substr(0, equals), setting);
  if (parts.front() == "include") {
    throw InputError(setting +
                     ": expected a value, and `include` names files that are read before "
                     "it; a scene of your own that includes both sets it");
  }
  if (text == "none" && removeTable(root, parts, setting)) return;
  Value* target = &root;
  std::string where;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::string& part = parts[k];
    if (target->isArray()) {
      target = &elementOf(*target, parts, k, where, setting);
    } else if (target->isTable()) {
      target = &memberOf(*target, part, setting);
    } else {
      throw InputError(
          fmt::format("{}: {}: expected a table, got {}", setting, where, describe(*target)));
    }
    if (!where.empty()) where += '.';
    where += part;
  }
  *target = parseSettingValue(text, setting);
}

const Value* findValue(const Value& root, const std::string& key) {
  const Value* found = &root;
  const std::vector<std::string> parts = splitKey(key, key);
  for (std::size_t k = 0; k < parts.size() && found != nullptr; ++k) {
    if (!found->isArray()) {
      found = found->find(parts[k]);
      continue;
    }
    const std::size_t index = indexOf(*found, parts, k);
    found = index < found->items.size() ? &found->items[index] : nullptr;
  }
  return found;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string* best = nullptr;
  size_t bestDistance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = editDistance(word, candidate);
    if (distance < bestDistance && distance < std::max(word.size(), candidate.size())) {
      bestDistance = distance;
      best = &candidate;
    }
  }
  return best == nullptr ? "" : fmt::format("; did you mean '{}'?", *best);
}

std::string nearestOrAll(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = didYouMean(word, candidates);
  if (!nearest.empty() || candidates.empty()) return nearest;
  const std::string& last = candidates.back();
  if (candidates.size() == 1) return "; expected " + last;
  const auto others = std::span(candidates).first(candidates.size() - 1);
  return fmt::format("; expected {} or {}", joined(others, ", "), last);
}

}  // namespace scenes
