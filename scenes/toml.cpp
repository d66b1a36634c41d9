// TOML text -> Value; the only file that knows toml++.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "scenes/value.h"

namespace scenes {
namespace {

Place placeOf(const toml::source_region& region) {
  return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), {}};
}

Value convert(const toml::node& node);

void convertTable(const toml::table& table, Value& out) {
  out.kind = Value::Kind::kTable;
  for (const auto& [key, node] : table) {
    out.members.push_back({std::string(key.str()), placeOf(key.source()), convert(node)});
  }
  std::stable_sort(out.members.begin(), out.members.end(), [](const Member& a, const Member& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
}

void convertArray(const toml::array& array, Value& out) {
  out.kind = Value::Kind::kArray;
  for (const toml::node& node : array) out.items.push_back(convert(node));
}

Value convert(const toml::node& node) {
  Value out;
  out.place = placeOf(node.source());
  if (const auto* table = node.as_table()) {
    convertTable(*table, out);
  } else if (const auto* array = node.as_array()) {
    convertArray(*array, out);
  } else if (const auto* boolean = node.as_boolean()) {
    out.kind = Value::Kind::kBoolean;
    out.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    out.kind = Value::Kind::kInteger;
    out.integer = integer->get();
    out.number = static_cast<double>(out.integer);
  } else if (const auto* number = node.as_floating_point()) {
    out.kind = Value::Kind::kNumber;
    out.number = number->get();
  } else if (const auto* text = node.as_string()) {
    out.kind = Value::Kind::kString;
    out.text = text->get();
  } else {
    out.kind = Value::Kind::kDate;
  }
  return out;
}

}  // namespace

Value parseToml(const std::string& text, const std::string& path) {
  try {
    return convert(toml::parse(text, path));
  } catch (const toml::parse_error& error) {
    const Place place = placeOf(error.source());
    throw InputError(fmt::format("{}:{}:{}: expected TOML: {}", path, place.line, place.column,
                                 error.description()));
  }
}

}  // namespace scenes
