// The numbered frames of an output folder, DIR/frames/00000.png and on.
#include "app/run/frame_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string>
#include <vector>

#include "app/base/output_file.h"

namespace app {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> filesEndingIn(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ending) files.push_back(entry.path());
  }
  return files;
}

bool isNumbered(const fs::path& file) {
  const std::string stem = file.stem().string();
  return std::all_of(stem.begin(), stem.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::vector<fs::path> numberedFrames(const fs::path& folder) {
  std::vector<fs::path> files = filesEndingIn(folder, ".png");
  std::erase_if(files, [](const fs::path& file) { return !isNumbered(file); });
  return files;
}

std::uint32_t bigEndian(const char* bytes) {
  std::uint32_t number = 0;
  for (int i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes[i]);
  return number;
}

// From the signature over the size in IHDR and every chunk's length to IEND and the end of the
// file; the pixels themselves are not unpacked. A chunk: length, name, data, checksum.
bool isWholePng(const fs::path& file, int width, int height) {
  using namespace std::string_literals;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 24> head{};
  if (error || !stream.read(head.data(), head.size())) return false;
  if (std::string(head.data(), 16) != "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s) return false;
  if (bigEndian(&head[16]) != static_cast<std::uint32_t>(width)) return false;
  if (bigEndian(&head[20]) != static_cast<std::uint32_t>(height)) return false;
  std::uintmax_t at = 8;
  std::array<char, 8> chunk{};
  while (stream.seekg(static_cast<std::streamoff>(at)).read(chunk.data(), chunk.size())) {
    at += 12 + std::uintmax_t{bigEndian(chunk.data())};
    if (std::string(&chunk[4], 4) == "IEND") return at == size;
  }
  return false;
}

}  // namespace

FrameFolder::FrameFolder(const fs::path& output) : folder_(output / "frames") {
  makeFolder(folder_);
}

fs::path FrameFolder::file(int frame) const { return folder_ / fmt::format("{:05}.png", frame); }

bool FrameFolder::has(int frame, int width, int height) const {
  return fs::is_regular_file(file(frame)) && isWholePng(file(frame), width, height);
}

int FrameFolder::count() const { return static_cast<int>(numberedFrames(folder_).size()); }

void FrameFolder::clear() const {
  for (const fs::path& frame : numberedFrames(folder_)) removeFile(frame);
}

void FrameFolder::removeLeftovers() const {
  for (const fs::path& folder : {folder_, folder_.parent_path()}) {
    for (const fs::path& file : filesEndingIn(folder, kPartial)) removeFile(file);
  }
}

}  // namespace app
