// Definitions that differ from their defaults in every member.
#pragma once

#include "physics/constraints/over_time.h"
#include "physics/make/soft.h"
#include "physics/make/tet_mesh.h"

namespace scenes {

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
  void change(const physics::Field& f, physics::Vec2& member) { member = {next(f), next(f)}; }
  void change(const physics::Field& f, physics::OverTime& member) {
    member = {{{next(f), next(f)}, {100, next(f)}}, true};
  }
  void change(const physics::Field&, std::array<physics::BodyId, 2>& member) { member = {1, 2}; }
  void change(const physics::Field&, std::array<int, 1>& member) { member = {2}; }
  void change(const physics::Field&, physics::BodyRef& member) { member.id = 2; }
  void change(const physics::Field&, physics::GridIndex& member) { member = {3, 2}; }
  void change(const physics::Field&, physics::TetMesh& member) {
    member = physics::boxMesh(physics::Vec3::Ones(), {1, 1, 1});
  }
  void change(const physics::Field&, std::array<int, 3>& member) { member = {2, 3, 4}; }
  void change(const physics::Field&, std::array<int, 4>& member) { member = {4, 3, 2, 1}; }
  void change(const physics::Field&, std::vector<int>& member) { member = {3, 1, 2}; }
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
    for (T& item : member) (*this)(f, item);
  }
};

}  // namespace scenes
