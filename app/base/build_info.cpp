// Which program this is.
#include "app/base/build_info.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <iterator>

namespace app {

std::string version() { return DBD_VERSION; }
std::string compiler() { return DBD_COMPILER; }
std::string compileFlags() { return DBD_FLAGS; }

std::string programHash() {
  std::ifstream program("/proc/self/exe", std::ios::binary);
  return hashText(std::string(std::istreambuf_iterator<char>(program), {}));
}

std::string hashText(std::string_view bytes) {
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

}  // namespace app
