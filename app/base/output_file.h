// Files that are whole or absent: written under a temporary name and renamed.
#pragma once

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "app/base/interrupt.h"

namespace app {

// Every function here throws EnvironmentError with the path and the system's reason.

// "-" is standard output. Devices and pipes (/dev/null, a fifo) are written in place.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();  // without commit(): nothing is left behind
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  void commit();  // now the file exists under its name

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_, written_;
  std::FILE* file_ = nullptr;
  bool standardOutput_ = false, renamed_ = false;
  std::optional<RemovedOnInterrupt> half_;
};

// What a command is to write, by its option; empty or "-": no file.
struct NamedOutput {
  const char* option;
  std::string file;
  bool isWhole = false;  // it takes its name when it is done: a pipe of that name would be gone
};
// None of them twice, and none that is read (empty: nothing is). Throws InputError.
void requireOwnFiles(std::initializer_list<NamedOutput> outputs, const std::string& read);

void writeFile(const std::filesystem::path& path, std::string_view bytes);
// The same for what is written again and again: the last but one stays beside it as spareOf(path),
// whose blocks take the next one in a third of the time.
void rewriteFile(const std::filesystem::path& path, std::string_view bytes);
std::filesystem::path spareOf(const std::filesystem::path& path);
void makeFolder(const std::filesystem::path& folder);
void removeFile(const std::filesystem::path& path);  // absent is fine

constexpr const char* kPartial = ".part";  // the ending of the temporary name

}  // namespace app
