// over_time = [[time, factor], ...]: a table that a force or a speed follows, written or in a file.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "scenes/read/table_reader.h"

namespace scenes {
namespace {

using physics::OverTime;

constexpr const char* kPoints = "an array of [time, factor]";

void readPoints(const Value& value, const Spot& spot, OverTime& out) {
  if (!value.isArray()) failExpected(spot, value, kPoints);
  for (const Value& item : value.items) {
    if (!item.isArray() || item.items.size() != 2) failExpected(spot, item, "[time, factor]");
    std::array<double, 2>& point = out.points.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      readValue(item.items[k], {spot.context, spot.key, {"over_time"}}, point[k]);
    }
  }
}

// "0.5, 1": false where it is not two numbers.
bool parseLine(const std::string& line, std::array<double, 2>& point) {
  const char* at = line.c_str();
  for (std::size_t k = 0; k < 2; ++k) {
    char* end = nullptr;
    point[k] = std::strtod(at, &end);
    if (end == at || !std::isfinite(point[k])) return false;
    for (at = end; *at == ' ' || *at == '\t' || *at == '\r'; ++at) continue;
    if (k == 0 && *at++ != ',') return false;
  }
  return *at == '\0';
}

// Lines of a time and a factor; the first may be heads, those that begin with # are passed over.
void readFile(const Value& value, const Spot& spot, OverTime& out) {
  std::string name;
  readValue(value, spot, name);
  const std::string path =
      (std::filesystem::path(folderOf(spot.context, value.place)) / name).string();
  std::ifstream in(path);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored) || !in) {
    fail(spot.context, value.place,
         fmt::format("{}: no file '{}' beside the scene", spot.key, name));
  }
  bool mayBeHeads = true;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r" || line[0] == '#') continue;
    std::array<double, 2> point{};
    if (parseLine(line, point)) {
      out.points.push_back(point);
    } else if (!mayBeHeads) {
      throw InputError(fmt::format("{}:{}: expected 'time, factor', got '{}'", path, number, line));
    }
    mayBeHeads = false;
  }
}

}  // namespace

void readValue(const Value& value, const Spot& spot, OverTime& out) {
  out = {};
  if (value.isTable()) {
    TableReader reader(value, spot.key, spot.context);
    reader(physics::Field{"repeat"}, out.repeat);
    reader.exactlyOne("points", "file");
    const Value *points = reader.take("points"), *file = reader.take("file");
    if (points != nullptr) readPoints(*points, reader.spot({"points"}), out);
    if (file != nullptr) readFile(*file, reader.spot({"file"}), out);
    reader.finish();
  } else if (value.isArray()) {
    readPoints(value, spot, out);
  } else {
    failExpected(spot, value, std::string(kPoints) + " or { points | file, repeat }");
  }
  try {
    check(out);
  } catch (const std::invalid_argument& error) {
    fail(spot.context, value.place, fmt::format("{}: {}", spot.key, error.what()));
  }
}

}  // namespace scenes
