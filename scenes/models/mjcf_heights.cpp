// MJCF: <hfield>, heights on a grid as numbers, a picture or a binary file.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "render/png.h"
#include "scenes/models/mesh_points.h"
#include "scenes/models/mjcf.h"

namespace scenes {
namespace {

constexpr int kMostRows = 401;  // of a [[body]]'s heights

// Numbers by row from the least y on, and by column along x.
struct Grid {
  int rows = 0, columns = 0;
  std::vector<double> heights;
};

// Grey levels; the first row of a picture is the one of the greatest y.
Grid ofPicture(const std::string& path) {
  const render::Image image = render::readPng(path);
  Grid grid{image.height, image.width, {}};
  for (int row = image.height; row-- > 0;) {
    for (int column = 0; column < image.width; ++column) {
      grid.heights.push_back(image.rgb[3 * static_cast<std::size_t>(row * image.width + column)]);
    }
  }
  return grid;
}

// Two integers, rows and columns, and a float for each.
Grid ofBinary(const Tag& tag, const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::int32_t size[2] = {0, 0};
  in.read(reinterpret_cast<char*>(size), sizeof size);
  if (!in || size[0] < 1 || size[1] < 1 || size[0] > kMostRows || size[1] > kMostRows) {
    tag.fail(fmt::format("{}: expected 1 to {} rows and columns, and a height for each", path,
                         kMostRows));
  }
  std::vector<float> heights(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]));
  in.read(reinterpret_cast<char*>(heights.data()),
          static_cast<std::streamsize>(heights.size() * sizeof(float)));
  if (!in) tag.fail(fmt::format("{}: expected {} heights", path, heights.size()));
  return {size[0], size[1], {heights.begin(), heights.end()}};
}

Grid ofNumbers(const Tag& tag) {
  const double rows = tag.number("nrow", 0), columns = tag.number("ncol", 0);
  if (!(rows >= 2 && columns >= 2 && rows <= kMostRows && columns <= kMostRows)) {
    tag.fail(fmt::format("nrow, ncol: expected 2 to {}, or a file", kMostRows));
  }
  Grid grid{static_cast<int>(rows), static_cast<int>(columns), tag.numbers("elevation")};
  const auto count = static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns);
  if (grid.heights.empty()) grid.heights.assign(count, 0);  // set by a program
  if (grid.heights.size() != count) {
    tag.fail(fmt::format("elevation: expected {} numbers, got {}", count, grid.heights.size()));
  }
  return grid;
}

Grid readGrid(const Tag& tag, const Mjcf& mjcf) {
  const std::string file = tag.text("file", "");
  if (file.empty()) return ofNumbers(tag);
  namespace fs = std::filesystem;
  const std::string path = (fs::path(mjcf.folder) / mjcf.compiler.meshFolder / file).string();
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) tag.fail(fmt::format("no file '{}'", path));
  if (endingOf(path) != ".png") return ofBinary(tag, path);
  try {
    return ofPicture(path);
  } catch (const std::exception& error) {
    tag.fail(error.what());
  }
}

}  // namespace

// Heights are from 0, the lowest, to size[2]. What is below is solid, to any depth.
void readHeightField(const XmlElement& element, Mjcf& mjcf) {
  const Tag tag = tagOf(element, mjcf);
  const std::vector<double> size = tag.numbers("size", 4);
  if (size.size() != 4 || !(size[0] > 0 && size[1] > 0 && size[2] > 0)) {
    tag.fail("size: expected four numbers > 0");
  }
  const Grid grid = readGrid(tag, mjcf);
  const auto [least, most] = std::minmax_element(grid.heights.begin(), grid.heights.end());
  const double low = *least, scale = *most > low ? size[2] / (*most - low) : 0;
  MjcfHeights heights{{2 * size[0], 2 * size[1]}, {}, grid.rows, grid.columns};
  if (std::max(grid.rows, grid.columns) <= kMostRows && std::min(grid.rows, grid.columns) >= 2) {
    for (int row = grid.rows; row-- > 0;) {  // ours begin at the least z, their greatest y
      std::vector<double>& line = heights.rows.emplace_back();
      for (int column = 0; column < grid.columns; ++column) {
        line.push_back(scale * (grid.heights[row * grid.columns + column] - low));
      }
    }
  }
  const std::string file = tag.text("file", "");
  mjcf.heights[tag.name(std::filesystem::path(file).stem().string())] = std::move(heights);
}

bool readHeightShape(const Tag& tag, const Mjcf& mjcf, ModelPart& part) {
  const std::string name = tag.required("hfield");
  const auto found = mjcf.heights.find(name);
  if (found == mjcf.heights.end()) tag.fail(fmt::format("no hfield '{}'", name));
  const MjcfHeights& heights = found->second;
  if (heights.rows.empty()) {
    tag.leaveOut(fmt::format("<geom> of {} x {} heights, of which 2 x 2 to {} x {} are",
                             heights.rowCount, heights.columnCount, kMostRows, kMostRows));
    return false;
  }
  part.extent = heights.extent;
  part.rows = heights.rows;
  part.mass = 0;
  return true;
}

}  // namespace scenes
