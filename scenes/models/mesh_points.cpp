// Points of a mesh file: OBJ, and STL as text or as 50 bytes a triangle.
#include "scenes/models/mesh_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "physics/bodies/shape.h"
#include "scenes/read/file_text.h"

namespace scenes {
namespace {

using physics::Vec3;

constexpr std::size_t kHead = 84, kTriangle = 50;  // bytes: a title and a count; a triangle
static_assert(std::endian::native == std::endian::little, "STL is little endian");

std::uint32_t countAt(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHead - 4, 4);
  return count;
}

bool isBinaryStl(const std::string& bytes) {
  return bytes.size() >= kHead && bytes.size() == kHead + kTriangle * std::size_t{countAt(bytes)};
}

std::vector<Vec3> binaryStl(const std::string& bytes) {
  std::vector<Vec3> points;
  for (std::size_t at = kHead; at < bytes.size(); at += kTriangle) {
    float numbers[9];  // behind the normal's three
    std::memcpy(numbers, bytes.data() + at + 12, sizeof numbers);
    for (int k = 0; k < 9; k += 3) points.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
  }
  return points;
}

// Lines "vertex x y z" of an STL, "v x y z" of an OBJ.
std::vector<Vec3> linesOf(const std::string& text, const std::string& key) {
  std::vector<Vec3> points;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word != key) continue;
    Vec3 point = Vec3::Zero();
    if (!(words >> point.x() >> point.y() >> point.z())) {
      throw std::invalid_argument(
          fmt::format("line {}: expected '{} x y z', got '{}'", number, key, line.substr(0, 60)));
    }
    points.push_back(point);
  }
  return points;
}

bool less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

std::string endingOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::vector<Vec3> meshPoints(const std::string& path) {
  const std::string ending = endingOf(path);
  if (ending != ".obj" && ending != ".stl") {
    throw std::invalid_argument("expected a mesh that is .obj or .stl");
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw std::invalid_argument("no such file");
  const std::optional<std::string> text = fileText(path);
  if (!text) throw std::invalid_argument("cannot be read");
  const bool binary = ending == ".stl" && isBinaryStl(*text);
  std::vector<Vec3> points =
      binary ? binaryStl(*text) : linesOf(*text, ending == ".stl" ? "vertex" : "v");
  for (const Vec3& point : points) {
    if (!point.allFinite()) throw std::invalid_argument("has a number that is not finite");
  }
  std::sort(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 4) {
    throw std::invalid_argument(fmt::format("expected at least 4 points, got {}", points.size()));
  }
  return points;
}

namespace {

// Corners of a hull, of which a hull can be made again.
std::vector<Vec3> cornersOf(const std::vector<Vec3>& points) {
  const physics::PrincipalHull hull = physics::makeHull(points);
  std::vector<Vec3> corners;
  for (const Vec3& vertex : hull.hull->vertices) {
    corners.push_back(hull.toPoints.x + hull.toPoints.q * vertex);
  }
  physics::makeHull(corners);
  return corners;
}

}  // namespace

// Where points nearly coincide a hull may not close: they are rounded to as little of their size as
// it takes.
std::vector<Vec3> hullCorners(const std::vector<Vec3>& points) {
  double size = 0;
  for (const Vec3& point : points) size = std::max(size, point.cwiseAbs().maxCoeff());
  std::vector<Vec3> rounded = points;
  for (const double part : {1e-6, 1e-5, 1e-4}) {
    try {
      return cornersOf(rounded);
    } catch (const std::invalid_argument&) {
      const double cell = part * size;
      if (!(cell > 0)) throw;
      for (std::size_t i = 0; i < points.size(); ++i) {
        rounded[i] = cell * (points[i] / cell).array().round().matrix();
      }
    }
  }
  return cornersOf(rounded);
}

}  // namespace scenes
