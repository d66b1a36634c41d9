// A file on its way: written beside its place under a name of its own, then renamed or removed.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace render {

class UnfinishedFile {
 public:
  explicit UnfinishedFile(std::filesystem::path place)
      : place_(std::move(place)),
        part_(fmt::format("{}.{}.part", place_.string(), static_cast<long>(::getpid()))) {}
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile() {
    std::error_code ignored;
    if (!finished_) std::filesystem::remove(part_, ignored);
  }

  const std::filesystem::path& part() const { return part_; }

  // Gives the file its name. Throws std::system_error that names it.
  void finish() {
    std::error_code error;
    std::filesystem::rename(part_, place_, error);
    if (error) throw std::system_error(error, fmt::format("cannot rename to {}", place_.string()));
    finished_ = true;
  }

 private:
  std::filesystem::path place_, part_;
  bool finished_ = false;
};

}  // namespace render
