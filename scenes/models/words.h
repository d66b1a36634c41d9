// Tables of scene files, made by hand.
#pragma once

#include <string>
#include <vector>

#include "physics/base/types.h"
#include "scenes/read/value.h"

namespace scenes {

// Values that were written at one place.
struct Words {
  Place place;

  Value number(double value) const;
  Value boolean(bool value) const;
  Value text(const std::string& value) const;
  Value array(std::vector<Value> items) const;
  Value texts(const std::vector<std::string>& items) const;
  Value numbers(const std::vector<double>& items) const;
  Value vector(const physics::Vec3& value) const;
  Value vectors(const std::vector<physics::Vec3>& values) const;
  Value quaternion(const physics::Quat& value) const;
  Value table() const;
  void set(Value& table, const char* key, Value value) const;
  // [[word]]: one more of the root's.
  void add(Value& root, const char* word, Value table) const;
};

}  // namespace scenes
