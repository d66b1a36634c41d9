// An 8-bit RGB image in memory, rows from the top.
#pragma once

#include <cstdint>
#include <vector>

namespace render {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width * height
  bool operator==(const Image&) const = default;
};

}  // namespace render
