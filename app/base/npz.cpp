// Writing arrays: each has its place from the start, so that its rows are written and read there;
// heads, checksums and the directory come when all is known. The .npy format is version 1.0.
#include "app/base/npz.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "app/base/npz_format.h"
#include "app/base/output_file.h"
#include "app/commands/exit_code.h"
#include "physics/base/archive.h"
#include "scenes/joined.h"

namespace app {

namespace {

using namespace npz;

const std::string kEnding = ".npy";

std::uint64_t itemBytes(const std::string& type) {
  return type.size() > 2 ? std::strtoull(type.c_str() + 2, nullptr, 10) : 0;
}

// "(300, 211, 7)", "(300,)", "()"
std::string shapeText(const std::vector<std::uint64_t>& shape) {
  return fmt::format("({}{})", scenes::joined(shape, ", "), shape.size() == 1 ? "," : "");
}

std::string arrayHead(const NpzArray& array, std::uint64_t rows) {
  std::vector<std::uint64_t> shape = array.shape;
  shape[0] = rows;
  const std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}",
                                       array.type, shapeText(shape));
  constexpr std::uint64_t kBefore = 10;
  std::string head("\x93NUMPY\x01\x00", 8);
  put(head, kArrayHead - kBefore, 2);
  head += text;
  head.resize(kArrayHead - 1, ' ');
  return head + '\n';
}

}  // namespace

std::uint64_t NpzArray::rowBytes() const {
  std::uint64_t bytes = itemBytes(type);
  for (std::size_t i = 1; i < shape.size(); ++i) bytes *= shape[i];
  return bytes;
}

void NpzFile::openPart(const char* ending, int flags) {
  if (path_.has_parent_path()) makeFolder(path_.parent_path());
  part_ = path_.string() + ending;
  descriptor_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | flags, 0666);
  if (descriptor_ < 0) fail("write", errno);
}

NpzFile NpzFile::create(const std::filesystem::path& path) {
  NpzFile file(path);
  file.openPart(kPartial, O_TRUNC);
  file.half_ = std::make_unique<RemovedOnInterrupt>(file.part_.string());
  return file;
}

NpzFile NpzFile::begin(const std::filesystem::path& path) {
  NpzFile file(path);
  file.stays_ = true;
  file.openPart(kBegun, O_TRUNC);
  return file;
}

NpzFile NpzFile::goOn(const std::filesystem::path& path) {
  NpzFile file(path);
  file.stays_ = true;
  file.openPart(kBegun, 0);
  return file;
}

void NpzFile::archive(physics::Archive& a) {
  for (Entry& entry : entries_) a(entry.rows, entry.rowsChecksum);
  if (!a.reads()) return;
  for (const Entry& entry : entries_) {
    std::uint32_t checksum = 0;
    try {
      checksum = checksumOf(entry.data, entry.data + entry.rows * entry.array.rowBytes());
    } catch (const std::out_of_range&) {
      throw std::invalid_argument(part_.string() + " ends too early");
    }
    physics::require(checksum == entry.rowsChecksum,
                     part_.string() + ": the checksum of '" + entry.array.name + "' is wrong");
  }
  struct stat status {};
  const auto size = static_cast<off_t>(end());
  const bool isLonger = ::fstat(descriptor_, &status) == 0 && status.st_size > size;
  if (isLonger && ::ftruncate(descriptor_, size) != 0) fail("write", errno);
}

NpzFile::NpzFile(NpzFile&& other) noexcept
    : path_(std::move(other.path_)),
      part_(std::exchange(other.part_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      stays_(other.stays_),
      entries_(std::move(other.entries_)),
      half_(std::move(other.half_)) {}

NpzFile::~NpzFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!part_.empty() && !stays_) ::unlink(part_.c_str());
}

std::uint64_t NpzFile::end() const {
  if (entries_.empty()) return 0;
  const Entry& last = entries_.back();
  return last.data + last.array.rowBytes() * (last.room == kGrows ? last.rows : last.room);
}

int NpzFile::add(NpzArray array) {
  Entry entry;
  entry.at = end();
  entry.head = entry.at + kLocalHead + array.name.size() + kEnding.size() + kLocalExtra;
  entry.data = entry.head + kArrayHead;
  entry.room = array.shape.at(0);
  entry.array = std::move(array);
  entries_.push_back(std::move(entry));
  return static_cast<int>(entries_.size()) - 1;
}

void NpzFile::append(int array, const void* rows, std::uint64_t count) {
  Entry& entry = entries_.at(static_cast<std::size_t>(array));
  const bool isLast = static_cast<std::size_t>(array) + 1 == entries_.size();
  const bool fits =
      entry.room == kGrows ? isLast : count <= entry.room && entry.rows <= entry.room - count;
  physics::require(fits, "an array has no room for more rows");
  const std::uint64_t bytes = entry.array.rowBytes();
  write(rows, count * bytes, entry.data + entry.rows * bytes);
  entry.rowsChecksum = libdeflate_crc32(entry.rowsChecksum, rows, count * bytes);
  entry.rows += count;
}

void NpzFile::commit() {
  for (Entry& entry : entries_) {
    const std::string head = arrayHead(entry.array, entry.rows);
    write(head.data(), head.size(), entry.head);
    entry.array.shape[0] = entry.rows;
    entry.checksum = checksumOf(entry.head, entry.data + entry.rows * entry.array.rowBytes());
    const std::string local = localHead(entry);
    write(local.data(), local.size(), entry.at);
  }
  const std::string last = directory();
  write(last.data(), last.size(), end());
  if (::rename(part_.c_str(), path_.c_str()) != 0) fail("write", errno);
  part_.clear();
  half_.reset();
}

std::string NpzFile::localHead(const Entry& entry) {
  const std::string name = entry.array.name + kEnding;
  const std::uint64_t size = kArrayHead + entry.rows * entry.array.rowBytes();
  std::string head;
  put(head, kLocalSign, 4);
  put(head, kVersion, 2);
  put(head, 0, 2 + 2 + 2);  // flags, stored, time
  put(head, kDate, 2);
  put(head, entry.checksum, 4);
  put(head, kSee64, 4);
  put(head, kSee64, 4);
  put(head, name.size(), 2);
  put(head, kLocalExtra, 2);
  head += name;
  put(head, 1, 2);
  put(head, kLocalExtra - 4, 2);
  put(head, size, 8);
  put(head, size, 8);
  return head;
}

std::string NpzFile::directory() const {
  std::string text;
  for (const Entry& entry : entries_) {
    const std::string name = entry.array.name + kEnding;
    const std::uint64_t size = kArrayHead + entry.rows * entry.array.rowBytes();
    put(text, kCentralSign, 4);
    put(text, kVersion, 2);
    put(text, kVersion, 2);
    put(text, 0, 2 + 2 + 2);  // flags, stored, time
    put(text, kDate, 2);
    put(text, entry.checksum, 4);
    put(text, kSee64, 4);
    put(text, kSee64, 4);
    put(text, name.size(), 2);
    put(text, kCentralExtra, 2);
    put(text, 0, 2 + 2 + 2 + 4);  // comment, disk, attributes
    put(text, kSee64, 4);
    text += name;
    put(text, 1, 2);
    put(text, kCentralExtra - 4, 2);
    put(text, size, 8);
    put(text, size, 8);
    put(text, entry.at, 8);
  }
  const std::uint64_t size = text.size(), at = end(), count = entries_.size();
  put(text, kEnd64Sign, 4);
  put(text, kEnd64 - 12, 8);
  put(text, kVersion, 2);
  put(text, kVersion, 2);
  put(text, 0, 4 + 4);  // disks
  put(text, count, 8);
  put(text, count, 8);
  put(text, size, 8);
  put(text, at, 8);
  put(text, kLocatorSign, 4);
  put(text, 0, 4);
  put(text, at + size, 8);
  put(text, 1, 4);
  put(text, kEndSign, 4);
  put(text, 0, 4);
  put(text, count, 2);
  put(text, count, 2);
  put(text, kSee64, 4);
  put(text, kSee64, 4);
  put(text, 0, 2);
  return text;
}

void NpzFile::write(const void* bytes, std::uint64_t count, std::uint64_t at) const {
  const char* from = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::pwrite(descriptor_, from, count, static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("write", written < 0 ? errno : EIO);
    from += written;
    at += static_cast<std::uint64_t>(written);
    count -= static_cast<std::uint64_t>(written);
  }
}

void NpzFile::fail(const char* what, int error) const {
  throw EnvironmentError(
      fmt::format("cannot {} {}: {}", what, path_.string(), std::strerror(error)));
}

}  // namespace app
