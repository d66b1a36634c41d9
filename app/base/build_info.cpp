// Which program this is.
#include "app/base/build_info.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <vector>

namespace app {

std::string version() { return DBD_VERSION; }
std::string compiler() { return DBD_COMPILER; }
std::string compileFlags() { return DBD_FLAGS; }

std::string programHash() {
  std::ifstream program("/proc/self/exe", std::ios::binary);
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  std::vector<char> piece(1 << 20);
  do {
    program.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    XXH3_64bits_update(&state, piece.data(), static_cast<std::size_t>(program.gcount()));
  } while (program);
  return fmt::format("{:016x}", XXH3_64bits_digest(&state));
}

std::string hashText(std::string_view bytes) {
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

}  // namespace app
