// All that a stream has left.
#pragma once

#include <istream>
#include <sstream>
#include <string>
#include <utility>

namespace render {

inline std::string bytesOf(std::istream& stream) {
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return std::move(bytes).str();
}

}  // namespace render
