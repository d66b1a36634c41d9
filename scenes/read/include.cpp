// include: tables of other files before those of the file.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scenes/models/read_model.h"
#include "scenes/read/expand.h"
#include "scenes/read/file_text.h"
#include "scenes/read/write_scene.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;

constexpr int kMostIncludes = 100;

// Of a model that includes others some have one already.
void noteFile(Value& value, const std::string& file) {
  if (value.place.file.empty()) value.place.file = file;
  for (Value& item : value.items) noteFile(item, file);
  for (Member& member : value.members) {
    if (member.place.file.empty()) member.place.file = file;
    noteFile(member.value, file);
  }
}

// `own` over `base`: tables key by key; at the top, rows of tables follow those of the base.
void merge(Value& base, Value own, bool atTop) {
  for (Member& member : own.members) {
    Value* there = base.find(member.key);
    if (there == nullptr) {
      base.members.push_back(std::move(member));
    } else if (there->isTable() && member.value.isTable()) {
      merge(*there, std::move(member.value), false);
    } else if (atTop && isTables(*there) && isTables(member.value)) {
      for (Value& item : member.value.items) there->items.push_back(std::move(item));
    } else {
      there->place = member.place;
      *there = std::move(member.value);
    }
  }
}

struct Includer {
  const Context& context;
  std::vector<std::string>& told;
  std::vector<std::string> open;  // the files that are being read, from the scene on
  std::string texts;
  int count = 0;

  void run(Value& tree);
  Value read(const Value& name);
  Value parse(const std::string& text, const std::string& path);
};

Value Includer::parse(const std::string& text, const std::string& path) {
  if (!isModel(text, path)) return parseToml(text, path);
  std::vector<std::string> ofModel;
  Value tree = readModel(text, path, ofModel);
  told.insert(told.end(), ofModel.begin(), ofModel.end());
  texts += tomlOf(tree, "");  // of the meshes and files that it has read, too
  return tree;
}

Value Includer::read(const Value& name) {
  const auto refuse = [&](const std::string& message) {
    fail(context, name.place, "include: " + message);
  };
  if (!name.isString()) refuse("expected a file's name, got " + describe(name));
  const fs::path path = (fs::path(folderOf(context, name.place)) / name.text).lexically_normal();
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    refuse(fmt::format("no file '{}' ({})", name.text, path.string()));
  }
  if (std::find(open.begin(), open.end(), path.string()) != open.end()) {
    refuse(fmt::format("{} includes itself", path.string()));
  }
  if (++count > kMostIncludes) refuse(fmt::format("more than {} files", kMostIncludes));
  const std::optional<std::string> text = fileText(path.string());
  if (!text) refuse(fmt::format("{}: expected a file that can be read", path.string()));
  texts += *text;
  Value tree = parse(*text, path.string());
  noteFile(tree, path.string());
  open.push_back(path.string());
  run(tree);
  open.pop_back();
  return tree;
}

void Includer::run(Value& tree) {
  const std::optional<Value> names = takeMember(tree, "include");
  if (!names) return;
  Value base;
  if (names->isArray()) {
    for (const Value& name : names->items) merge(base, read(name), true);
  } else {
    merge(base, read(*names), true);
  }
  base.place = tree.place;
  merge(base, std::move(tree), true);
  tree = std::move(base);
}

}  // namespace

std::string includeFiles(Value& tree, const Context& context, std::vector<std::string>& told) {
  Includer includer{context, told, {fs::path(context.path).lexically_normal().string()}, {}};
  includer.run(tree);
  return includer.texts;
}

}  // namespace scenes
