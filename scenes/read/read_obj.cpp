// Reads the lines of an OBJ file that tell its form: v and f.
#include "scenes/read/read_obj.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenes/scene.h"

namespace scenes {
namespace {

using physics::Vec3;

struct ObjLine {
  std::string path;
  int number = 0;
  std::string text;

  [[noreturn]] void expected(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: expected {}, got '{}'", path, number, what, text));
  }
};

void readVertex(std::istream& words, const ObjLine& line, ObjMesh& mesh) {
  Vec3 point = Vec3::Zero();
  if (!(words >> point.x() >> point.y() >> point.z()) || !point.allFinite()) {
    line.expected("'v x y z'");
  }
  mesh.vertices.push_back(point);
}

// "f 1 2 3", "f 1/4/2 2/5/2 -1//2": the first number counts vertices from 1, or from the last back.
void readFace(std::istream& words, const ObjLine& line, ObjMesh& mesh) {
  const auto count = static_cast<long>(mesh.vertices.size());
  std::vector<int> corners;
  for (std::string word; words >> word;) {
    const long number = std::strtol(word.c_str(), nullptr, 10);
    const long index = number < 0 ? count + number : number - 1;
    if (number == 0 || index < 0 || index >= count) {
      line.expected(fmt::format("'f' and corners of the {} vertices above", count));
    }
    corners.push_back(static_cast<int>(index));
  }
  if (corners.size() < 3) line.expected("'f' and at least three corners");
  for (std::size_t k = 2; k < corners.size(); ++k) {
    mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }
}

}  // namespace

std::string findMesh(const std::string& file, const Value& value, const Spot& spot) {
  namespace fs = std::filesystem;
  const fs::path beside = fs::path(folderOf(spot.context, value.place)) / file;
  const fs::path inAssets = fs::path(assetFolder()) / "meshes" / file;
  std::error_code ignored;
  if (fs::is_regular_file(beside, ignored)) return beside.string();
  if (fs::is_regular_file(inAssets, ignored)) return inAssets.string();
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(inAssets.parent_path(), ignored)) {
    names.push_back(entry.path().filename().string());
  }
  fail(spot.context, value.place,
       fmt::format("{}: no mesh '{}' beside the scene or in assets/meshes{}", spot.key, file,
                   didYouMean(file, names)));
}

ObjMesh readObj(const std::string& file, const Value& value, const Spot& spot) {
  ObjLine line{findMesh(file, value, spot), 0, {}};
  std::ifstream in(line.path);
  ObjMesh mesh;
  while (std::getline(in, line.text)) {
    ++line.number;
    std::istringstream words(line.text);
    std::string word;
    words >> word;
    if (word == "v") readVertex(words, line, mesh);
    if (word == "f" && mesh.vertices.empty()) break;  // of nothing
    if (word == "f") readFace(words, line, mesh);
  }
  if (mesh.vertices.empty()) {
    fail(spot.context, value.place,
         fmt::format("{}: expected a mesh with vertices, got the empty '{}'", spot.key, file));
  }
  return mesh;
}

}  // namespace scenes
