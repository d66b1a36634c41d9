// Ground of triangles: out of an OBJ file, or of heights on a grid.
#include "scenes/read/read_ground.h"

#include <fmt/format.h>

#include "physics/bodies/triangles.h"
#include "scenes/read/expression.h"
#include "scenes/read/read_obj.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;
using physics::Vec3;

constexpr int kMostCells = 400;         // along an edge of a field of heights
constexpr int kMostTriangles = 500000;  // of a mesh: some 150 MB

physics::Triangles made(const TableReader& reader, const char* source,
                        std::span<const Vec3> vertices,
                        std::span<const std::array<int, 3>> triangles) {
  if (triangles.size() > kMostTriangles) {
    reader.failAt(source, fmt::format("expected at most {} triangles, got {}", kMostTriangles,
                                      triangles.size()));
  }
  try {
    return {physics::makeTriangleMesh(vertices, triangles)};
  } catch (const std::invalid_argument& error) {
    reader.failAt(source, error.what());
  }
}

// Heights [m] by row and column: a row along x for each z, from -z to +z.
using Rows = std::vector<std::vector<double>>;

Rows rowsOf(TableReader& reader, const physics::Vec2& size, const std::string& formula) {
  std::array<int, 2> cells{40, 40};
  const Spot spot = reader.spot(Field{"cells", Unit::kNone, false, 1, kMostCells});
  if (const Value* value = reader.take("cells")) {
    if (!value->isArray() || value->items.size() != 2) failExpected(spot, *value, "[nx, nz]");
    for (int k = 0; k < 2; ++k) readValue(value->items[k], spot, cells[k]);
  }
  Expressions expressions;
  Rows rows(cells[1] + 1, std::vector<double>(cells[0] + 1));
  try {
    for (int j = 0; j <= cells[1]; ++j) {
      expressions.define("z", size.y() * (static_cast<double>(j) / cells[1] - 0.5));
      for (int i = 0; i <= cells[0]; ++i) {
        expressions.define("x", size.x() * (static_cast<double>(i) / cells[0] - 0.5));
        rows[j][i] = expressions.evaluate(formula);
      }
    }
  } catch (const ExpressionError& error) {
    reader.failAt("formula", error.what());
  }
  return rows;
}

void checkRows(const TableReader& reader, const Rows& rows) {
  const std::size_t columns = rows.empty() ? 0 : rows[0].size();
  bool fits = rows.size() >= 2 && columns >= 2 && rows.size() <= kMostCells + 1 &&
              columns <= kMostCells + 1;
  for (const auto& row : rows) fits = fits && row.size() == columns;
  if (fits) return;
  reader.failAt("rows", fmt::format("expected 2 to {} rows of one length, of 2 to {} heights",
                                    kMostCells + 1, kMostCells + 1));
}

physics::Triangles surfaceOf(const TableReader& reader, const char* source,
                             const physics::Vec2& size, const Rows& rows) {
  const int nz = static_cast<int>(rows.size()), nx = static_cast<int>(rows[0].size());
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j < nz; ++j) {
    for (int i = 0; i < nx; ++i) {
      vertices.emplace_back(size.x() * (i / (nx - 1.0) - 0.5), rows[j][i],
                            size.y() * (j / (nz - 1.0) - 0.5));
    }
  }
  for (int j = 0; j + 1 < nz; ++j) {
    for (int i = 0; i + 1 < nx; ++i) {  // diagonals in turn, so that no direction is better
      const int a = j * nx + i, b = a + 1, c = a + nx, d = c + 1;
      if ((i + j) % 2 == 0) {
        triangles.push_back({a, c, d});
        triangles.push_back({a, d, b});
      } else {
        triangles.push_back({a, c, b});
        triangles.push_back({b, c, d});
      }
    }
  }
  return made(reader, source, vertices, triangles);
}

}  // namespace

physics::Triangles readTriangles(TableReader& reader) {
  std::string file;
  double scale = 1;
  reader(Field{"mesh", Unit::kNone, true}, file);
  reader(Field{"scale", Unit::kNone, false, kPositive}, scale);
  ObjMesh mesh = readObj(file, *reader.take("mesh"), reader.spot(Field{"mesh"}));
  for (Vec3& vertex : mesh.vertices) vertex *= scale;
  return made(reader, "mesh", mesh.vertices, mesh.triangles);
}

physics::Triangles readHeights(TableReader& reader) {
  physics::Vec2 size(10, 10);
  std::string formula;
  Rows rows;
  reader(Field{"size", Unit::kMetre, true, kPositive}, size);
  reader(Field{"formula"}, formula);
  reader(Field{"rows", Unit::kMetre}, rows);
  reader.exactlyOne("rows", "formula");
  if (reader.has("rows")) {
    checkRows(reader, rows);
    return surfaceOf(reader, "rows", size, rows);
  }
  return surfaceOf(reader, "formula", size, rowsOf(reader, size, formula));
}

}  // namespace scenes
