// A definition as the TOML table that reads back to it, and definitions that differ from their
// defaults.
#pragma once

#include <fmt/format.h>

#include "physics/make/matter.h"
#include "scenes/table_reader.h"

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
inline std::string textOf(const physics::Quat& q) {
  return fmt::format("[{:.12g}, {:.12g}, {:.12g}, {:.12g}]", q.w(), q.x(), q.y(), q.z());
}
inline std::string textOf(const std::array<physics::BodyId, 2>& b) {
  return fmt::format("[\"b{}\", \"b{}\"]", b[0], b[1]);
}
inline std::string textOf(const std::array<int, 3>& n) {
  return fmt::format("[{}, {}, {}]", n[0], n[1], n[2]);
}
inline std::string textOf(const std::array<double, 2>& p) {
  return fmt::format("[{:.12g}, {:.12g}]", p[0], p[1]);
}
inline std::string textOf(const std::array<physics::Vec3, 2>& p) {
  return "[" + textOf(p[0]) + ", " + textOf(p[1]) + "]";
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
std::string textOf(const std::vector<T>& items) {
  std::string text;
  for (const T& item : items) text += (text.empty() ? "" : ", ") + textOf(item);
  return "[" + text + "]";
}

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
    } else {
      put(field.name, textOf(member));
    }
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

template <class Def>
std::string textOfDef(Def& def) {
  FieldWriter writer;
  Def::fields(writer, def);
  return writer.text;
}

// The visitor that gives every member a value of its own within its bounds.
struct FieldChanger {
  int counter = 0;

  double next(const physics::Field& field) {
    const double low = std::max(field.low, 0.0);
    const double high = std::min(field.high, low + 90);
    const double part = 0.1 + 0.01 * (++counter % 50);
    const double value = low + part * (high - low);
    return field.unit == physics::Unit::kDegrees ? value * M_PI / 180 : value;
  }
  template <class T>
  void operator()(const physics::Field& field, T& member) {
    if constexpr (requires { T::fields(*this, member); }) {
      T::fields(*this, member);
    } else if constexpr (requires { member.has_value(); }) {
      if (!member) member.emplace();
      (*this)(field, *member);
    } else {
      change(field, member);
    }
  }
  void change(const physics::Field&, bool& member) { member = !member; }
  void change(const physics::Field& f, int& member) { member = static_cast<int>(next(f)) + 1; }
  void change(const physics::Field& f, unsigned& member) {
    member = static_cast<unsigned>(next(f));
  }
  void change(const physics::Field& f, double& member) { member = next(f); }
  void change(const physics::Field&, std::string& member) { member += "x"; }
  void change(const physics::Field& f, physics::Vec3& member) {
    for (int i = 0; i < 3; ++i) member[i] = next(f);
  }
  void change(const physics::Field&, physics::Quat& member) {
    member = physics::Quat(0.6, 0, 0.8, 0);
  }
  void change(const physics::Field&, std::array<physics::BodyId, 2>& member) { member = {1, 2}; }
  void change(const physics::Field&, std::array<int, 3>& member) { member = {2, 3, 4}; }
  void change(const physics::Field& f, std::array<double, 2>& member) {
    member[0] = next(f);
    member[1] = member[0] + 0.01;
  }
  void change(const physics::Field& f, std::array<physics::Vec3, 2>& member) {
    for (physics::Vec3& v : member) change(f, v);
  }
  void change(const physics::Field&, physics::Friction& member) { member = {0.7, 0.4}; }
  void change(const physics::Field&, physics::Shape& member) {
    member = physics::Box{physics::Vec3(1, 2, 3)};
  }
  template <class E>
  requires std::is_enum_v<E>
  void change(const physics::Field&, E& member) { member = static_cast<E>(1); }
  template <class T>
  void change(const physics::Field& f, std::vector<T>& member) {
    member.resize(2);
    for (T& item : member) change(f, item);
  }
};

}  // namespace scenes
