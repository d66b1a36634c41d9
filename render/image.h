// An 8-bit image in memory, rows from the top.
#pragma once

#include <cstdint>
#include <vector>

namespace render {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;      // 3 * width * height
  std::vector<std::uint8_t> alpha{};  // width * height, or empty: opaque; not multiplied into rgb
  bool operator==(const Image&) const = default;
};

}  // namespace render
