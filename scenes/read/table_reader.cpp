// The walk over a table: known keys, unknown keys, keys that exclude each other.
#include "scenes/read/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace scenes {

void fail(const Context& context, const Place& place, const std::string& message) {
  if (!place.setting.empty()) throw InputError(place.setting + ": " + message);
  const std::string& file = place.file.empty() ? context.path : place.file;
  throw InputError(fmt::format("{}:{}:{}: {}", file, place.line, place.column, message));
}

std::string folderOf(const Context& context, const Place& place) {
  const std::string& file = place.file.empty() ? context.path : place.file;
  return std::filesystem::path(file).parent_path().string();
}

void failExpected(const Spot& spot, const Value& value, const std::string& expected) {
  fail(spot.context, value.place,
       fmt::format("{}: expected {}, got {}", spot.key, expected, describe(value)));
}

TableReader::TableReader(const Value& table, std::string key, const Context& context)
    : table_(table), key_(std::move(key)), context_(context) {}

const Value* TableReader::take(const std::string& name) {
  if (!knows(name)) known_.push_back(name);
  if (context_.glossary != nullptr) context_.glossary->note(key_, {name, "", "", "", "", false});
  return table_.find(name);
}

int TableReader::choose(const char* name, std::span<const char* const> choices, int otherwise) {
  if (context_.glossary != nullptr) {
    const char* standard = choices[static_cast<std::size_t>(otherwise)];
    context_.glossary->note(key_, {name, choiceWord(choices), standard, "", "", false});
  }
  const Value* value = take(name);
  return value == nullptr ? otherwise : readChoice(*value, spot({name}), choices);
}

bool TableReader::knows(const std::string& name) const {
  return std::find(known_.begin(), known_.end(), name) != known_.end();
}

Spot TableReader::spot(const physics::Field& field) const {
  return {context_, key_.empty() ? field.name : key_ + "." + field.name, field};
}

void TableReader::failHere(const std::string& message) const {
  fail(context_, table_.place, key_.empty() ? message : key_ + ": " + message);
}

void TableReader::failAt(const char* name, const std::string& message) const {
  const Value* value = table_.find(name);
  if (value == nullptr) failHere(message);
  fail(context_, value->place, fmt::format("{}.{}: {}", key_, name, message));
}

void TableReader::atMostOne(const char* a, const char* b) const {
  if (has(a) && has(b)) failAt(b, fmt::format("expected '{}' or '{}', not both", a, b));
}

void TableReader::exactlyOne(const char* a, const char* b) const {
  atMostOne(a, b);
  if (!has(a) && !has(b)) failHere(fmt::format("expected '{}' or '{}'", a, b));
}

void TableReader::finish() const {
  if (context_.glossary != nullptr) context_.glossary->noteTable(key_);
  for (const Member& member : table_.members) {
    if (knows(member.key)) continue;
    const bool isTable = member.value.isTable() || isTables(member.value);
    fail(context_, member.place,
         fmt::format("{}unknown {} '{}'{}", key_.empty() ? "" : key_ + ": ",
                     isTable ? "table" : "key", member.key, nearestOrAll(member.key, known_)));
  }
}

}  // namespace scenes
