// A definition as the TOML table that reads back to it.
#pragma once

#include <fmt/format.h>

#include "physics/make/soft.h"
#include "scenes/read/table_reader.h"

namespace scenes {

inline std::string textOf(bool value) { return value ? "true" : "false"; }
inline std::string textOf(int value) { return fmt::format("{}", value); }
inline std::string textOf(unsigned value) { return fmt::format("{}", value); }
inline std::string textOf(double value) {
  return std::isfinite(value) ? fmt::format("{:.12g}", value) : "inf";
}
inline std::string textOf(const std::string& value) { return '"' + value + '"'; }
inline std::string textOf(const physics::Vec3& v) {
  return fmt::format("[{:.12g}, {:.12g}, {:.12g}]", v.x(), v.y(), v.z());
}
inline std::string textOf(const physics::Vec2& v) {
  return fmt::format("[{:.12g}, {:.12g}]", v.x(), v.y());
}
inline std::string textOf(const physics::BodyRef& body) { return fmt::format("\"b{}\"", body.id); }
inline std::string textOf(const physics::GridIndex& node) {
  return fmt::format("[{}, {}]", node.i, node.j);
}
inline std::string textOf(const physics::TetMesh&) { return "\"torus.mesh\""; }
inline std::string textOf(const physics::Quat& q) {
  return fmt::format("[{:.12g}, {:.12g}, {:.12g}, {:.12g}]", q.w(), q.x(), q.y(), q.z());
}
inline std::string textOf(const std::array<physics::BodyId, 2>& b) {
  return fmt::format("[\"b{}\", \"b{}\"]", b[0], b[1]);
}
inline std::string textOf(const std::array<physics::BodyId, 1>& b) { return textOf(b[0]); }
inline std::string textOf(const std::array<physics::BodyId, 4>& b) { return textOf(b[0]); }
inline std::string textOf(const std::array<int, 3>& n) {
  return fmt::format("[{}, {}, {}]", n[0], n[1], n[2]);
}
inline std::string textOf(const std::array<double, 2>& p) {
  return fmt::format("[{:.12g}, {:.12g}]", p[0], p[1]);
}
inline std::string textOf(const physics::OverTime& table) {
  std::string points;
  for (const auto& point : table.points) points += (points.empty() ? "" : ", ") + textOf(point);
  return fmt::format("{{ points = [{}], repeat = {} }}", points, table.repeat);
}
inline std::string textOf(const std::array<physics::Vec3, 2>& p) {
  return fmt::format("[{}, {}]", textOf(p[0]), textOf(p[1]));
}
inline std::string textOf(const physics::Friction& f) {
  return fmt::format("{{ static = {}, dynamic = {} }}", f.staticCoefficient, f.dynamicCoefficient);
}
inline std::string textOf(const physics::Shape& shape) {
  return "{ box = { size = " + textOf(std::get<physics::Box>(shape).size) + " } }";
}
template <class E>
requires std::is_enum_v<E> std::string textOf(E value) {
  return std::string("\"") + names(value)[static_cast<size_t>(value)] + '"';
}
template <class T>
std::string textOf(const std::vector<T>& items);

// The visitor that writes.
struct FieldWriter {
  std::string separator = "\n";
  std::string text;

  template <class T>
  void operator()(const physics::Field& field, T& member) {
    if constexpr (requires { T::fields(*this, member); }) {
      FieldWriter nested{", ", ""};
      T::fields(nested, member);
      put(field.name, "{ " + nested.text + " }");
    } else if constexpr (requires { member.has_value(); }) {
      if (member) (*this)(field, *member);
    } else if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::array<double, 2>>) {
      T inDegrees = member;
      if (field.unit == physics::Unit::kDegrees) scale(inDegrees, 180 / M_PI);
      put(field.name, textOf(inDegrees));
    } else if constexpr (requires { bodyNames(member); }) {
      put(field.name, field.unit == physics::Unit::kBody ? bodyNames(member) : textOf(member));
    } else {
      put(field.name, textOf(member));
    }
  }
  template <std::size_t N>
  static std::string bodyNames(const std::array<int, N>& bodies) {
    return N == 1 ? fmt::format("\"b{}\"", bodies[0]) : bodyNames({bodies.begin(), bodies.end()});
  }
  static std::string bodyNames(const std::vector<int>& bodies) {
    std::string text;
    for (const int body : bodies) text += fmt::format("{}\"b{}\"", text.empty() ? "" : ", ", body);
    return "[" + text + "]";
  }
  static void scale(double& value, double factor) { value *= factor; }
  static void scale(std::array<double, 2>& pair, double factor) {
    for (double& value : pair) value *= factor;
  }
  void put(const std::string& name, const std::string& value) {
    if (!text.empty()) text += separator;
    text += name + " = " + value;
  }
};

template <class T>
std::string textOf(const std::vector<T>& items) {
  std::string text;
  for (T item : items) {
    text += text.empty() ? "" : ", ";
    if constexpr (requires(FieldWriter & writer) { T::fields(writer, item); }) {
      FieldWriter nested{", ", ""};
      T::fields(nested, item);
      text += "{ " + nested.text + " }";
    } else {
      text += textOf(item);
    }
  }
  return "[" + text + "]";
}

template <class Def>
std::string textOfDef(Def& def) {
  FieldWriter writer;
  Def::fields(writer, def);
  return writer.text;
}

}  // namespace scenes
