// Arrays in a file as NumPy keeps them: .npz, a zip archive of .npy files, here never compressed,
// so that any row is read at its place, and while others are still being written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/base/interrupt.h"

namespace physics {
class Archive;
}

namespace app {

constexpr const char* kBegun = ".begun";

struct NpzArray {
  std::string name;
  std::string type;                  // NumPy's: "<f8", "<u8", "|S12"; little-endian
  std::vector<std::uint64_t> shape;  // the first counts rows

  std::uint64_t rowBytes() const;
};

// Several processes may read from one NpzFile that they inherited.
class NpzFile {
 public:
  // Written under a temporary name until commit(); without it nothing is left behind. Throws
  // EnvironmentError.
  static NpzFile create(const std::filesystem::path& path);
  // The same, but without commit() it stays, as path + kBegun; or as that is, whose arrays are then
  // added as they were, before `archive` tells how many rows there are.
  static NpzFile begin(const std::filesystem::path& path);
  static NpzFile goOn(const std::filesystem::path& path);
  // What goOn() needs beside the file. A reader drops all rows that were not there, and throws
  // std::invalid_argument where the others are not as they were.
  void archive(physics::Archive& a);
  // Throws InputError where it is not whole, which its checksums tell, or of a kind not read here.
  static NpzFile open(const std::filesystem::path& path);

  NpzFile(NpzFile&& other) noexcept;
  NpzFile(const NpzFile&) = delete;
  ~NpzFile();

  // An array for shape[0] rows at the most, all of which come later. Where that is kGrows, as many
  // come as come, before the next array is added.
  static constexpr std::uint64_t kGrows = ~std::uint64_t{0};
  int add(NpzArray array);
  void append(int array, const void* rows, std::uint64_t count);
  void commit();  // now the file exists under its name

  const NpzArray& array(int index) const { return entries_[static_cast<std::size_t>(index)].array; }
  std::uint64_t rows(int array) const;
  int find(const std::string& name) const;  // -1: none
  void read(int array, std::uint64_t first, std::uint64_t count, void* to) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  struct Entry {
    NpzArray array;
    std::uint64_t room = 0, rows = 0;
    std::uint64_t at = 0, head = 0, data = 0;  // of the entry, of its .npy, of the first row
    std::uint32_t checksum = 0;
    std::uint32_t rowsChecksum = 0;  // of those that were appended
  };
  explicit NpzFile(std::filesystem::path path) : path_(std::move(path)) {}
  void openPart(const char* ending, int flags);
  std::uint64_t end() const;
  static std::string localHead(const Entry& entry);
  std::string directory() const;
  std::uint32_t checksumOf(std::uint64_t from, std::uint64_t end) const;
  std::string bytesAt(std::uint64_t at, std::uint64_t count) const;
  Entry readEntry(const std::string& directory, std::size_t& at) const;
  void readDirectory();
  void write(const void* bytes, std::uint64_t count, std::uint64_t at) const;
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void fail(const char* what, int error) const;

  std::filesystem::path path_, part_;  // part_: empty once it has its name
  int descriptor_ = -1;
  bool stays_ = false;  // without commit()
  std::vector<Entry> entries_;
  std::unique_ptr<RemovedOnInterrupt> half_;
};

}  // namespace app
