// Reading arrays: the directory at the end of the file tells where they are.
#include <fcntl.h>
#include <libdeflate.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "app/base/npz.h"
#include "app/base/npz_format.h"
#include "scenes/read/input_error.h"

namespace app {

namespace {

using namespace npz;

// The value after 'key': in the head of a .npy file, up to `end`.
std::string valueOf(const std::string& head, const std::string& key, char end) {
  const std::size_t at = head.find("'" + key + "':");
  if (at == std::string::npos) return "";
  const std::size_t from = head.find_first_not_of(" '(", at + key.size() + 3);
  const std::size_t to = head.find(end, from);
  return from == std::string::npos || to == std::string::npos ? "" : head.substr(from, to - from);
}

std::vector<std::uint64_t> parseShape(const std::string& text) {
  std::vector<std::uint64_t> shape;
  const char* at = text.c_str();
  while (*at != '\0') {
    char* stop = nullptr;
    shape.push_back(std::strtoull(at, &stop, 10));
    if (stop == at) return {};
    at = stop + std::strspn(stop, ", ");
  }
  return shape;
}

// The number in the 64-bit field of a directory entry that stands for `small`. `at` goes on.
std::uint64_t wide(std::uint64_t small, const std::string& extra, std::size_t& at) {
  if (small != kSee64) return small;
  at += 8;
  return number(extra, at - 8, 8);
}

}  // namespace

NpzFile NpzFile::open(const std::filesystem::path& path) {
  NpzFile file(path);
  file.descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file.descriptor_ < 0) file.refuse(std::strerror(errno));
  try {
    file.readDirectory();
  } catch (const std::out_of_range&) {
    file.refuse("it is no whole .npz file");
  }
  for (const Entry& entry : file.entries_) {
    const std::uint64_t end = entry.data + entry.rows * entry.array.rowBytes();
    if (file.checksumOf(entry.head, end) != entry.checksum) {
      file.refuse("the checksum of '" + entry.array.name + "' is wrong: the file is damaged");
    }
  }
  return file;
}

void NpzFile::readDirectory() {
  const off_t size = ::lseek(descriptor_, 0, SEEK_END);
  if (size < static_cast<off_t>(kEnd)) refuse("it is no .npz file");
  const std::uint64_t endAt = static_cast<std::uint64_t>(size) - kEnd;
  const std::string last = bytesAt(endAt, kEnd);
  if (number(last, 0, 4) != kEndSign) refuse("it is no .npz file");
  std::uint64_t count = number(last, 10, 2), length = number(last, 12, 4), at = number(last, 16, 4);
  if (at == kSee64) {
    const std::string locator = bytesAt(endAt - kLocator, kLocator);
    const std::string wideEnd = bytesAt(number(locator, 8, 8), kEnd64);
    if (number(wideEnd, 0, 4) != kEnd64Sign) refuse("it is no .npz file");
    count = number(wideEnd, 32, 8);
    length = number(wideEnd, 40, 8);
    at = number(wideEnd, 48, 8);
  }
  if (at > endAt || length > endAt - at) refuse("it is no whole .npz file");
  const std::string directory = bytesAt(at, length);
  std::size_t from = 0;
  for (std::uint64_t i = 0; i < count; ++i) entries_.push_back(readEntry(directory, from));
}

NpzFile::Entry NpzFile::readEntry(const std::string& directory, std::size_t& at) const {
  const std::size_t nameBytes = number(directory, at + 28, 2), more = number(directory, at + 30, 2);
  const std::string name = directory.substr(at + kCentralHead, nameBytes);
  const std::string extra = directory.substr(at + kCentralHead + nameBytes, more);
  Entry entry;
  entry.checksum = static_cast<std::uint32_t>(number(directory, at + 16, 4));
  std::size_t field = 4;
  const std::uint64_t size = wide(number(directory, at + 24, 4), extra, field);
  const std::uint64_t packed = wide(number(directory, at + 20, 4), extra, field);
  entry.at = wide(number(directory, at + 42, 4), extra, field);
  if (number(directory, at + 10, 2) != 0 || packed != size) {
    refuse("'" + name + "' is compressed; numpy.savez keeps it as it is");
  }
  at += kCentralHead + nameBytes + more + number(directory, at + 32, 2);

  const std::string local = bytesAt(entry.at, kLocalHead);
  const std::uint64_t from = entry.at + kLocalHead + number(local, 26, 2) + number(local, 28, 2);
  const std::string lead = bytesAt(from, 10);
  const std::uint64_t head = 10 + number(lead, 8, 2);
  if (lead.substr(0, 7) != "\x93NUMPY\x01" || head > size) refuse("'" + name + "' is no .npy");
  const std::string text = bytesAt(from + 10, head - 10);
  entry.array.name = name.substr(0, name.rfind(".npy"));
  entry.array.type = valueOf(text, "descr", '\'');
  entry.array.shape = parseShape(valueOf(text, "shape", ')'));
  entry.head = from;
  entry.data = from + head;
  const bool isScalar = entry.array.shape.empty();  // as one row
  if (isScalar) entry.array.shape = {1};
  entry.rows = entry.room = entry.array.shape[0];
  const std::uint64_t bytes = entry.array.rowBytes(), room = size - head;
  const bool fits = bytes == 0 ? room == 0 : entry.rows == room / bytes && room % bytes == 0;
  if (valueOf(text, "fortran_order", ',') != "False" || !fits) {
    refuse("'" + name + "' is of a kind that is not read here");
  }
  return entry;
}

std::uint32_t NpzFile::checksumOf(std::uint64_t from, std::uint64_t end) const {
  constexpr std::uint64_t kPiece = 1 << 20;
  std::uint32_t checksum = 0;
  for (std::uint64_t at = from; at < end; at += kPiece) {
    const std::string piece = bytesAt(at, std::min(kPiece, end - at));
    checksum = libdeflate_crc32(checksum, piece.data(), piece.size());
  }
  return checksum;
}

std::uint64_t NpzFile::rows(int array) const {
  return entries_.at(static_cast<std::size_t>(array)).rows;
}

int NpzFile::find(const std::string& name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.array.name == name; });
  return found == entries_.end() ? -1 : static_cast<int>(found - entries_.begin());
}

void NpzFile::read(int array, std::uint64_t first, std::uint64_t count, void* to) const {
  const Entry& entry = entries_.at(static_cast<std::size_t>(array));
  const std::uint64_t bytes = entry.array.rowBytes();
  const std::string got = bytesAt(entry.data + first * bytes, count * bytes);
  std::memcpy(to, got.data(), got.size());
}

std::string NpzFile::bytesAt(std::uint64_t at, std::uint64_t count) const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) fail("read", errno);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (at > size || count > size - at) throw std::out_of_range("the file ends before");
  std::string bytes(count, '\0');
  std::uint64_t done = 0;
  while (done < count) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + done, count - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("read", errno);
    if (got == 0) throw std::out_of_range("the file ends before");
    done += static_cast<std::uint64_t>(got);
  }
  return bytes;
}

void NpzFile::refuse(const std::string& why) const {
  throw scenes::InputError(path_.string() + ": " + why);
}

}  // namespace app
