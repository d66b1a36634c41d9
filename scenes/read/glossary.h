// The words that a reading asked for: every table and key with type, unit, default and range, noted
// by the reader itself.
#pragma once

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/base/fields.h"
#include "physics/bodies/body.h"
#include "physics/make/soft.h"
#include "physics/make/tet_mesh.h"

namespace scenes {

struct GlossaryKey {
  std::string name;
  std::string type;      // empty: what the key takes is read by hand
  std::string standard;  // where the key is absent; empty: nothing, or it follows from others
  std::string unit, range;
  bool required = false;
};

struct Glossary {
  // By the table's name in errors: "" is the file, "chain.end" a table in a table. What is the same
  // in many is one: "shape.box", "rotation", "friction".
  std::map<std::string, std::vector<GlossaryKey>> tables;

  // The first note of a key counts, and any type more than none; a default that differs from note
  // to note follows from others and is none.
  void note(const std::string& table, GlossaryKey key);
  void noteTable(const std::string& table);  // which may have no keys
};

// What a table or a key means, as "body.mass"; "*.mass" is that of any table without a line of its
// own. `type`: of what is read by hand. A test holds them against what the reader asks for.
struct Meaning {
  const char *path, *type, *text;
};
std::span<const Meaning> sharedMeanings();  // tables, and keys of any
std::span<const Meaning> ownMeanings();
const Meaning* findMeaning(const std::string& table, const std::string& key);  // null: none

// Every table and key that the reader asks for in the scenes that are shipped, and no other. Throws
// InputError where there are none.
Glossary shippedGlossary();

std::string unitWord(physics::Unit unit);
std::string rangeWord(const physics::Field& field);
std::string choiceWord(std::span<const char* const> choices);

// What a key of this member takes.
template <class T>
std::string typeWord(const physics::Field& field) {
  const bool bodies = field.unit == physics::Unit::kBody;
  if constexpr (requires {
                  typename T::value_type;
                  requires std::is_same_v<T, std::optional<typename T::value_type>>;
                }) {
    return typeWord<typename T::value_type>(field);
  } else if constexpr (requires { T::kTypeWord; }) {
    return T::kTypeWord;
  } else if constexpr (std::is_same_v<T, bool>) {
    return "true | false";
  } else if constexpr (std::is_integral_v<T>) {
    return "integer";
  } else if constexpr (std::is_same_v<T, double>) {
    return "number";
  } else if constexpr (std::is_same_v<T, std::string>) {
    return "text";
  } else if constexpr (std::is_same_v<T, physics::Vec3>) {
    return "[x, y, z]";
  } else if constexpr (std::is_same_v<T, physics::Vec2>) {
    return "[width, height]";
  } else if constexpr (std::is_same_v<T, physics::Quat>) {
    return "[w, x, y, z] | { axis, degrees }";
  } else if constexpr (std::is_same_v<T, std::array<double, 2>>) {
    return "[low, high]";
  } else if constexpr (std::is_same_v<T, std::array<physics::Vec3, 2>>) {
    return "[[x, y, z], [x, y, z]]";
  } else if constexpr (std::is_same_v<T, std::array<int, 3>>) {
    return bodies ? "3 bodies" : "[nx, ny, nz]";
  } else if constexpr (std::is_same_v<T, std::array<physics::BodyId, 1>> ||
                       std::is_same_v<T, physics::BodyRef>) {
    return "a body";
  } else if constexpr (std::is_same_v<T, std::array<physics::BodyId, 2>>) {
    return "2 bodies";
  } else if constexpr (std::is_same_v<T, std::array<physics::BodyId, 4>>) {
    return "4 bodies";
  } else if constexpr (std::is_same_v<T, std::vector<int>>) {
    return bodies ? "bodies" : "integers";
  } else if constexpr (std::is_same_v<T, physics::GridIndex>) {
    return "[i, j]";
  } else if constexpr (std::is_same_v<T, physics::Friction>) {
    return "number | { static, dynamic }";
  } else if constexpr (std::is_same_v<T, physics::Shape>) {
    return "a shape";
  } else if constexpr (std::is_same_v<T, physics::TetMesh>) {
    return "a .mesh file | { obj, cells }";
  } else if constexpr (std::is_enum_v<T>) {
    return choiceWord(names(T{}));
  } else if constexpr (requires { typename T::value_type; }) {
    return "array of " + typeWord<typename T::value_type>(field);
  } else {
    return "table";
  }
}

// What the member holds before anything is read.
template <class T>
std::string standardWord(const physics::Field& field, const T& member) {
  const double scale = field.unit == physics::Unit::kDegrees ? 180 / M_PI : 1;
  if constexpr (requires { member.has_value(); }) {
    return member ? standardWord(field, *member) : "";
  } else if constexpr (std::is_same_v<T, bool>) {
    return member ? "true" : "false";
  } else if constexpr (std::is_integral_v<T>) {
    return fmt::format("{}", member);
  } else if constexpr (std::is_same_v<T, double>) {
    return fmt::format("{:.6g}", scale * member);
  } else if constexpr (std::is_same_v<T, physics::Vec3>) {
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", member.x(), member.y(), member.z());
  } else if constexpr (std::is_same_v<T, physics::Vec2>) {
    return fmt::format("[{:.6g}, {:.6g}]", member.x(), member.y());
  } else if constexpr (std::is_same_v<T, std::array<double, 2>>) {
    return fmt::format("[{:.6g}, {:.6g}]", scale * member[0], scale * member[1]);
  } else if constexpr (std::is_same_v<T, std::array<int, 3>>) {
    return field.unit == physics::Unit::kBody
               ? ""
               : fmt::format("[{}, {}, {}]", member[0], member[1], member[2]);
  } else if constexpr (std::is_same_v<T, physics::Friction>) {
    return fmt::format("{{ {}, {} }}", member.staticCoefficient, member.dynamicCoefficient);
  } else if constexpr (std::is_enum_v<T>) {
    return names(member)[static_cast<std::size_t>(member)];
  } else {
    return "";
  }
}

template <class T>
GlossaryKey glossaryKey(const physics::Field& field, const T& member) {
  return {
      field.name,           typeWord<T>(field), field.required ? "" : standardWord(field, member),
      unitWord(field.unit), rangeWord(field),   field.required};
}

}  // namespace scenes
