// Reads a table of a scene file into a definition by walking its `fields`; what nobody asked for is
// an error.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "physics/body.h"
#include "physics/fields.h"
#include "physics/make/tet_mesh.h"
#include "scenes/value.h"

namespace physics {
struct BodyRef;
struct GridIndex;
}  // namespace physics

namespace scenes {

// What errors and names need to know about the file being read.
struct Context {
  std::string path;                                             // as the user gave it
  const std::map<std::string, physics::BodyId>* ids = nullptr;  // every name a constraint may use
};

// The place a value is read for: "file:line:col: key: " begins its errors.
struct Spot {
  const Context& context;
  std::string key;  // "body.mass"
  physics::Field field;
};

[[noreturn]] void fail(const Context& context, const Place& place, const std::string& message);
[[noreturn]] void failExpected(const Spot& spot, const Value& value, const std::string& expected);

// Bounds for numbers that must not be zero; shown as "> 0".
inline constexpr double kPositive = std::numeric_limits<double>::min();

void readValue(const Value& value, const Spot& spot, bool& out);
void readValue(const Value& value, const Spot& spot, int& out);
void readValue(const Value& value, const Spot& spot, unsigned& out);
void readValue(const Value& value, const Spot& spot, double& out);
void readValue(const Value& value, const Spot& spot, std::string& out);
void readValue(const Value& value, const Spot& spot, physics::Vec3& out);
void readValue(const Value& value, const Spot& spot, physics::Vec2& out);
void readValue(const Value& value, const Spot& spot, physics::Quat& out);
void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 1>& out);
void readValue(const Value& value, const Spot& spot, physics::BodyRef& out);
void readValue(const Value& value, const Spot& spot, physics::GridIndex& out);
void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 2>& out);
void readValue(const Value& value, const Spot& spot, std::array<int, 3>& out);  // or bodies
void readValue(const Value& value, const Spot& spot, std::array<physics::BodyId, 4>& out);
void readValue(const Value& value, const Spot& spot, std::vector<int>& out);  // or bodies
void readValue(const Value& value, const Spot& spot, std::array<double, 2>& out);
void readValue(const Value& value, const Spot& spot, std::array<physics::Vec3, 2>& out);
void readValue(const Value& value, const Spot& spot, physics::Friction& out);
void readValue(const Value& value, const Spot& spot, physics::Shape& out);
void readValue(const Value& value, const Spot& spot, physics::TetMesh& out);

// The index of the word in `choices`.
int readChoice(const Value& value, const Spot& spot, std::span<const char* const> choices);

class TableReader {
 public:
  // `key` names the table in errors; `table` must outlive the reader.
  TableReader(const Value& table, std::string key, const Context& context);

  // The visitor of `fields`.
  template <class T>
  void operator()(const physics::Field& field, T& member) {
    const Value* value = take(field.name);
    if (value != nullptr) return readValue(*value, spot(field), member);
    if (field.required) failHere("expected a value for '" + std::string(field.name) + "'");
  }

  const Value* take(const std::string& name);  // null where absent; the name is known from now on
  bool has(const std::string& name) const { return table_.find(name) != nullptr; }
  bool knows(const std::string& name) const;

  void atMostOne(const char* a, const char* b) const;
  void exactlyOne(const char* a, const char* b) const;
  void finish() const;  // throws at the first key nobody asked for

  const Value& table() const { return table_; }
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
