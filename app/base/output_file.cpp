// Files that are whole or absent: written under a temporary name and renamed.
#include "app/base/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include "app/base/console.h"
#include "app/commands/exit_code.h"
#include "scenes/read/input_error.h"

namespace app {

namespace fs = std::filesystem;

namespace {

bool isInPlace(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

[[noreturn]] void failToWrite(const fs::path& path, int error) {
  throw EnvironmentError("cannot write " + path.string() + ": " +
                         std::strerror(error != 0 ? error : EIO));
}

// Over what is there, to the same length.
void overwrite(const fs::path& path, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  int error = file < 0 ? errno : 0;
  for (std::string_view left = bytes; error == 0 && !left.empty();) {
    const ssize_t written = ::write(file, left.data(), left.size());
    if (written > 0) left.remove_prefix(static_cast<std::size_t>(written));
    if (written <= 0 && errno != EINTR) error = errno;
  }
  if (error == 0 && ::ftruncate(file, static_cast<off_t>(bytes.size())) != 0) error = errno;
  if (file >= 0 && ::close(file) != 0 && error == 0) error = errno;
  if (error != 0) failToWrite(path, error);
}

}  // namespace

OutputFile::OutputFile(fs::path path) : path_(std::move(path)), standardOutput_(path_ == "-") {
  if (standardOutput_) return;
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) fail(EISDIR);
  if (path_.has_parent_path()) makeFolder(path_.parent_path());
  renamed_ = !isInPlace(path_);
  written_ = renamed_ ? fs::path(path_.string() + kPartial) : path_;
  if (renamed_) half_.emplace(written_.string());
  file_ = std::fopen(written_.c_str(), "wb");
  if (file_ == nullptr) fail(errno);
}

OutputFile::~OutputFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  if (renamed_) std::remove(written_.c_str());
}

void OutputFile::write(std::string_view bytes) {
  if (standardOutput_) return say(bytes);
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(errno);
}

void OutputFile::commit() {
  if (standardOutput_) return flushOutput();
  errno = 0;
  const bool flushed = std::fflush(file_) == 0;
  const int error = errno;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (flushed && closed && (!renamed_ || std::rename(written_.c_str(), path_.c_str()) == 0)) return;
  const int reason = flushed ? errno : error;
  if (renamed_) std::remove(written_.c_str());
  fail(reason);
}

void OutputFile::fail(int error) const {
  if (standardOutput_ && error == EPIPE) throw ReaderGone(std::strerror(error));
  failToWrite(path_, error);
}

namespace {

bool areOne(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const auto whole = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  return whole(a) == whole(b) || fs::equivalent(a, b, error);
}

}  // namespace

void requireOwnFiles(std::initializer_list<NamedOutput> outputs, const std::string& read) {
  std::vector<NamedOutput> files;
  for (const NamedOutput& output : outputs) {
    if (!output.file.empty() && output.file != "-") files.push_back(output);
  }
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto refuse = [&](const std::string& why) {
      throw scenes::InputError(fmt::format("{} {}: {}", files[k].option, files[k].file, why));
    };
    if (!read.empty() && areOne(files[k].file, read)) {
      refuse("that is what is read, and it would be gone; name another file");
    }
    for (std::size_t other = 0; other < k; ++other) {
      if (!areOne(files[k].file, files[other].file)) continue;
      refuse(fmt::format("{} writes that file; name another", files[other].option));
    }
    if (files[k].isWhole && isInPlace(files[k].file)) refuse("expected a file, that is none");
  }
}

void writeFile(const fs::path& path, std::string_view bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.commit();
}

fs::path spareOf(const fs::path& path) { return path.string() + kPartial; }

void rewriteFile(const fs::path& path, std::string_view bytes) {
  if (path.has_parent_path()) makeFolder(path.parent_path());
  const fs::path spare = spareOf(path);
  overwrite(spare, bytes);
  if (::renameat2(AT_FDCWD, spare.c_str(), AT_FDCWD, path.c_str(), RENAME_EXCHANGE) == 0) return;
  // There is none to exchange it with, or the file system cannot.
  if (std::rename(spare.c_str(), path.c_str()) != 0) failToWrite(path, errno);
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw EnvironmentError("cannot make " + folder.string() + ": " + error.message());
}

void removeFile(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw EnvironmentError("cannot remove " + path.string() + ": " + error.message());
}

}  // namespace app
