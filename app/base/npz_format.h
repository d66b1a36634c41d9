// What the zip archive around NumPy's arrays is made of (APPNOTE 6.3, 64-bit sizes throughout), and
// its numbers, little-endian.
#pragma once

#include <cstdint>
#include <string>

namespace app::npz {

constexpr std::uint64_t kArrayHead = 128;  // of a .npy file; a multiple of 64, as NumPy has it
constexpr std::uint64_t kLocalHead = 30, kCentralHead = 46, kEnd = 22, kEnd64 = 56, kLocator = 20;
constexpr std::uint64_t kLocalExtra = 20, kCentralExtra = 28;
constexpr std::uint32_t kLocalSign = 0x04034b50, kCentralSign = 0x02014b50, kEndSign = 0x06054b50,
                        kEnd64Sign = 0x06064b50, kLocatorSign = 0x07064b50;
constexpr std::uint32_t kSee64 = 0xffffffff;  // the number stands in the 64-bit field
constexpr int kVersion = 45, kDate = 0x21;    // that has them; 1980-01-01

inline void put(std::string& to, std::uint64_t number, int bytes) {
  for (int i = 0; i < bytes; ++i, number >>= 8) to += static_cast<char>(number);
}

inline std::uint64_t number(const std::string& from, std::size_t at, int bytes) {
  std::uint64_t result = 0;
  for (int i = bytes - 1; i >= 0; --i) {
    result = result << 8 | static_cast<unsigned char>(from.at(at + static_cast<std::size_t>(i)));
  }
  return result;
}

}  // namespace app::npz
