// The numbered frames of an output folder, DIR/frames/00000.png and on.
#include "app/frame_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "app/output_file.h"

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

}  // namespace

FrameFolder::FrameFolder(const fs::path& output) : folder_(output / "frames") {
  makeFolder(folder_);
}

fs::path FrameFolder::file(int frame) const { return folder_ / fmt::format("{:05}.png", frame); }

bool FrameFolder::has(int frame) const { return fs::is_regular_file(file(frame)); }

bool FrameFolder::empty() const { return numberedFrames(folder_).empty(); }

void FrameFolder::clear() const {
  for (const fs::path& frame : numberedFrames(folder_)) removeFile(frame);
}

void FrameFolder::removeLeftovers() const {
  for (const fs::path& folder : {folder_, folder_.parent_path()}) {
    for (const fs::path& file : filesEndingIn(folder, kPartial)) removeFile(file);
  }
}

}  // namespace app
