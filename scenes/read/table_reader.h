// Reads a table of a scene file into a definition by walking its `fields`; what nobody asked for is
// an error.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/read/glossary.h"
#include "scenes/read/read_value.h"

namespace scenes {

class TableReader {
 public:
  // `key` names the table in errors; `table` must outlive the reader.
  TableReader(const Value& table, std::string key, const Context& context);

  // The visitor of `fields`.
  template <class T>
  void operator()(const physics::Field& field, T& member) {
    if (context_.glossary != nullptr) {
      context_.glossary->note(key_, glossaryKey(field, member));
    }
    const Value* value = take(field.name);
    if (value != nullptr) return readValue(*value, spot(field), member);
    if (field.required) failHere("expected a value for '" + std::string(field.name) + "'");
  }

  const Value* take(const std::string& name);  // null where absent; the name is known from now on
  // The index of a word among `choices`; `otherwise` where absent.
  int choose(const char* name, std::span<const char* const> choices, int otherwise);
  bool has(const std::string& name) const { return table_.find(name) != nullptr; }
  bool knows(const std::string& name) const;

  void atMostOne(const char* a, const char* b) const;
  void exactlyOne(const char* a, const char* b) const;
  void finish() const;  // throws at the first key nobody asked for

  const Value& table() const { return table_; }
  const std::string& key() const { return key_; }
  const Context& context() const { return context_; }
  Spot spot(const physics::Field& field) const;
  [[noreturn]] void failHere(const std::string& message) const;
  [[noreturn]] void failAt(const char* name, const std::string& message) const;

 private:
  const Value& table_;
  std::string key_;
  const Context& context_;
  std::vector<std::string> known_;
};

template <class E>
requires std::is_enum_v<E>
void readValue(const Value& value, const Spot& spot, E& out) {
  out = static_cast<E>(readChoice(value, spot, names(E{})));
}

template <class T>
requires requires(TableReader& reader, T& d) { T::fields(reader, d); }
void readValue(const Value& value, const Spot& spot, T& out) {
  if (!value.isTable()) failExpected(spot, value, "a table");
  TableReader reader(value, spot.key, spot.context);
  T::fields(reader, out);
  reader.finish();
}

template <class T>
void readValue(const Value& value, const Spot& spot, std::optional<T>& out) {
  T read{};
  if (out) read = *out;
  readValue(value, spot, read);
  out = read;
}

template <class T>
void readValue(const Value& value, const Spot& spot, std::vector<T>& out) {
  if (!value.isArray()) failExpected(spot, value, "an array");
  out.clear();
  for (const Value& item : value.items) {
    T read{};
    readValue(item, spot, read);
    out.push_back(std::move(read));
  }
}

}  // namespace scenes
