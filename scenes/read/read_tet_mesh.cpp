// Medit's ASCII .mesh files: Vertices and Tetrahedra; other sections are passed over.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "physics/make/tet_fill.h"
#include "scenes/read/read_obj.h"
#include "scenes/read/table_reader.h"

namespace scenes {
namespace {

constexpr int kMostItems = 10'000'000;

// The words of a file and the lines they stand on; # begins a comment.
class Words {
 public:
  explicit Words(const std::string& path) : file_(path) {}

  bool next(std::string& word) {
    while (!(words_ >> word)) {
      std::string text;
      if (!std::getline(file_, text)) return false;
      ++line_;
      words_.clear();
      words_.str(text.substr(0, text.find('#')));
    }
    return true;
  }

  double number(const char* what) {
    std::string word;
    if (!next(word)) fail(fmt::format("expected {}, got the end of the file", what));
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end == word.c_str() || *end != '\0' || !std::isfinite(value)) {
      fail(fmt::format("expected {}, got '{}'", what, word));
    }
    return value;
  }

  int integer(const char* what, int low) {
    const double value = number(what);
    if (value != std::floor(value) || value < low || value > kMostItems) {
      fail(fmt::format("expected {}, got {}", what, value));
    }
    return static_cast<int>(value);
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw std::invalid_argument(fmt::format("line {}: {}", line_, message));
  }

 private:
  std::ifstream file_;
  std::istringstream words_;
  int line_ = 0;
};

void readVertices(Words& words, physics::TetMesh& mesh) {
  const int count = words.integer("the number of vertices", 1);
  for (int i = 0; i < count; ++i) {
    physics::Vec3 node = physics::Vec3::Zero();
    for (int k = 0; k < 3; ++k) node[k] = words.number("a finite coordinate of a vertex");
    words.number("the reference of a vertex");
    mesh.nodes.push_back(node);
  }
}

void readTetrahedra(Words& words, physics::TetMesh& mesh) {
  const int count = words.integer("the number of tetrahedra", 1);
  for (int i = 0; i < count; ++i) {
    std::array<int, 4> tet{};
    for (int& corner : tet) corner = words.integer("the number of a vertex, from 1", 1) - 1;
    words.number("the reference of a tetrahedron");
    mesh.tets.push_back(tet);
  }
}

physics::TetMesh readMedit(const std::string& path) {
  Words words(path);
  physics::TetMesh mesh;
  for (std::string word; words.next(word) && word != "End";) {
    if (word == "Dimension" && words.integer("a dimension", 0) != 3) {
      words.fail("expected a mesh of dimension 3");
    }
    if (word == "Vertices") readVertices(words, mesh);
    if (word == "Tetrahedra") readTetrahedra(words, mesh);
  }
  if (mesh.nodes.empty()) throw std::invalid_argument("expected a section 'Vertices', got none");
  if (mesh.tets.empty()) throw std::invalid_argument("expected a section 'Tetrahedra', got none");
  orient(mesh);
  return mesh;
}

// { obj = "gem.obj", cells = 10 }: tetrahedra inside of a closed surface.
void readFilled(const Value& value, const Spot& spot, physics::TetMesh& out) {
  TableReader reader(value, spot.key, spot.context);
  std::string file;
  int cells = 8;
  reader(physics::Field{"obj", physics::Unit::kNone, true}, file);
  reader(physics::Field{"cells", physics::Unit::kNone, false, 1, 100}, cells);
  reader.finish();
  const Value& named = *value.find("obj");
  const ObjMesh surface = readObj(file, named, reader.spot({"obj"}));
  try {
    out = physics::fillMesh(surface.vertices, surface.triangles, cells);
    orient(out);
  } catch (const std::invalid_argument& error) {
    fail(spot.context, named.place, fmt::format("{}.obj: {}: {}", spot.key, file, error.what()));
  }
}

}  // namespace

void readValue(const Value& value, const Spot& spot, physics::TetMesh& out) {
  if (value.isTable()) return readFilled(value, spot, out);
  std::string file;
  readValue(value, spot, file);
  const std::string path = findMesh(file, value, spot);
  try {
    out = readMedit(path);
  } catch (const std::invalid_argument& error) {
    fail(spot.context, value.place, fmt::format("{}: {}: {}", spot.key, file, error.what()));
  }
}

}  // namespace scenes
