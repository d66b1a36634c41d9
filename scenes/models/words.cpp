// Tables of scene files, made by hand.
#include "scenes/models/words.h"

namespace scenes {

Value Words::number(double value) const {
  Value out;
  out.kind = Value::Kind::kNumber;
  out.place = place;
  out.number = value == 0 ? 0 : value;  // no -0
  return out;
}

Value Words::boolean(bool value) const {
  Value out;
  out.kind = Value::Kind::kBoolean;
  out.place = place;
  out.boolean = value;
  return out;
}

Value Words::text(const std::string& value) const {
  Value out;
  out.kind = Value::Kind::kString;
  out.place = place;
  out.text = value;
  return out;
}

Value Words::array(std::vector<Value> items) const {
  Value out;
  out.kind = Value::Kind::kArray;
  out.place = place;
  out.items = std::move(items);
  return out;
}

Value Words::texts(const std::vector<std::string>& items) const {
  std::vector<Value> out;
  for (const std::string& item : items) out.push_back(text(item));
  return array(std::move(out));
}

Value Words::numbers(const std::vector<double>& items) const {
  std::vector<Value> out;
  for (const double item : items) out.push_back(number(item));
  return array(std::move(out));
}

Value Words::vector(const physics::Vec3& value) const {
  return array({number(value.x()), number(value.y()), number(value.z())});
}

Value Words::vectors(const std::vector<physics::Vec3>& values) const {
  std::vector<Value> out;
  for (const physics::Vec3& value : values) out.push_back(vector(value));
  return array(std::move(out));
}

Value Words::quaternion(const physics::Quat& value) const {
  return array({number(value.w()), number(value.x()), number(value.y()), number(value.z())});
}

Value Words::table() const {
  Value out;
  out.place = place;
  return out;
}

void Words::set(Value& table, const char* key, Value value) const {
  table.members.push_back({key, place, std::move(value)});
}

void Words::add(Value& root, const char* word, Value table) const {
  Value* rows = root.find(word);
  if (rows == nullptr) {
    set(root, word, array({}));
    rows = &root.members.back().value;
  }
  rows->items.push_back(std::move(table));
}

}  // namespace scenes
