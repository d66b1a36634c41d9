// Values as TOML, on one line each, under the headers of their tables.
#include "scenes/read/write_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "scenes/joined.h"
#include "scenes/read/recipe.h"

namespace scenes {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string keyText(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  return bare ? key : quoted(key);
}

// The shortest digits that give the same number; with a point, so that it stays no integer.
std::string numberText(double number) {
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number > 0 ? "inf" : "-inf";
  const std::string text = fmt::format("{}", number);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

// Writes what stands in line; names of files beside an included file become those beside the scene.
class Writer {
 public:
  explicit Writer(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::string text(const Value& value) const {
    switch (value.kind) {
      case Value::Kind::kTable:
        return tableText(value);
      case Value::Kind::kArray: {
        std::vector<std::string> items;
        for (const Value& item : value.items) items.push_back(text(item));
        return fmt::format("[{}]", joined(items, ", "));
      }
      case Value::Kind::kBoolean:
        return value.boolean ? "true" : "false";
      case Value::Kind::kInteger:
        return fmt::format("{}", value.integer);
      case Value::Kind::kNumber:
        return numberText(value.number);
      case Value::Kind::kString:
      case Value::Kind::kDate:
        break;
    }
    return quoted(fileFromHere(value));
  }

  std::string lines(const Value& table) const {
    std::string out;
    for (const Member& member : table.members) {
      out += fmt::format("{} = {}\n", keyText(member.key), text(member.value));
    }
    return out;
  }

 private:
  std::string tableText(const Value& table) const {
    std::vector<std::string> members;
    for (const Member& member : table.members) {
      members.push_back(fmt::format("{} = {}", keyText(member.key), text(member.value)));
    }
    return members.empty() ? "{}" : fmt::format("{{ {} }}", joined(members, ", "));
  }

  std::string fileFromHere(const Value& value) const {
    namespace fs = std::filesystem;
    if (value.place.file.empty() || value.text.empty()) return value.text;
    const fs::path file = fs::path(value.place.file).parent_path() / value.text;
    std::error_code ignored;
    const bool isFile =
        fs::is_regular_file(file, ignored) || fs::is_regular_file(file.string() + ".toml", ignored);
    return isFile ? file.lexically_relative(folder_).string() : value.text;
  }

  std::filesystem::path folder_;
};

bool beginsAfter(const Value& expectation, double end) {
  const Value* from = expectation.find("from");
  return from != nullptr && expectation.find("to") == nullptr && from->number > end;
}

}  // namespace

std::string tomlOf(const Value& tree, const std::string& folder) {
  const Writer writer(folder);
  std::string values, tables;
  for (const Member& member : tree.members) {
    const Value& value = member.value;
    if (value.isTable()) {
      tables += fmt::format("\n[{}]\n{}", keyText(member.key), writer.lines(value));
    } else if (isTables(value)) {
      for (const Value& item : value.items) {
        tables += fmt::format("\n[[{}]]\n{}", keyText(member.key), writer.lines(item));
      }
    } else {
      values += fmt::format("{} = {}\n", keyText(member.key), writer.text(value));
    }
  }
  return values + tables;
}

std::string textOf(const Scene& scene) {
  Value tree = scene.content->tree;
  takeMember(tree, "golden");
  if (Value* expectations = tree.find("expect")) {
    std::erase_if(expectations->items,
                  [&](const Value& item) { return beginsAfter(item, scene.duration); });
    if (expectations->items.empty()) takeMember(tree, "expect");
  }
  return tomlOf(tree, std::filesystem::path(scene.path).parent_path().string());
}

}  // namespace scenes
