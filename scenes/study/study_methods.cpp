// Reads scenes/studies/methods.toml.
#include "scenes/study/study_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scenes/read/settings_reader.h"
#include "scenes/study/study_files.h"
#include "scenes/view/palette.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

StudyMethod readMethod(TableReader& reader, const std::vector<StudyMethod>& earlier) {
  StudyMethod method;
  reader(Field{"name", Unit::kNone, true}, method.name);
  reader(Field{"title", Unit::kNone, true}, method.title);
  reader(Field{"about"}, method.about);
  reader.atMostOne("set", "peer");
  reader(Field{"set"}, method.set);
  reader(Field{"peer"}, method.peer);
  reader(Field{"color", Unit::kNone, true}, method.color);
  reader(Field{"marker"}, method.marker);
  reader(Field{"iterates"}, method.iterates);
  reader.atMostOne("asks", "peer");
  reader(Field{"asks"}, method.asks);
  const bool isHash = method.color.size() == 7 && method.color[0] == '#';
  if (!isHash || !namedColor(method.color)) reader.failAt("color", "expected '#rrggbb'");
  for (const StudyMethod& other : earlier) {
    if (other.name == method.name) {
      reader.failAt("name", fmt::format("'{}' is a method already", method.name));
    }
  }
  return method;
}

}  // namespace

std::span<const char* const> names(StudyMethod::Marker) {
  static constexpr const char* kNames[] = {
      "circle",       "square",        "triangle",    "triangle_down", "diamond",
      "pentagon",     "circle_open",   "square_open", "triangle_open", "triangle_down_open",
      "diamond_open", "pentagon_open", "plus",        "cross",         "star"};
  return kNames;
}

std::vector<StudyMethod> parseStudyMethods(const std::string& text, const std::string& path) {
  const Value tree = parseToml(text, path);
  const Context context{path, nullptr};
  TableReader root(tree, "", context);
  std::vector<StudyMethod> methods;
  readTables(root, "method",
             [&](TableReader& reader) { methods.push_back(readMethod(reader, methods)); });
  root.finish();
  if (methods.empty()) root.failHere("expected at least one [[method]]");
  return methods;
}

std::vector<StudyMethod> studyMethods() {
  const std::string path = (std::filesystem::path(studyFolder()) / "methods.toml").string();
  return parseStudyMethods(readStudyText(path), path);
}

}  // namespace scenes
