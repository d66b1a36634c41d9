// The numbered frames of an output folder, DIR/frames/00000.png and on.
#pragma once

#include <filesystem>

namespace app {

class FrameFolder {
 public:
  explicit FrameFolder(const std::filesystem::path& output);  // makes it

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path file(int frame) const;
  bool has(int frame, int width, int height) const;  // whole: a PNG of that size, to its end
  int count() const;                                 // of numbered frames, whole or not
  void clear() const;                                // removes every frame
  void removeLeftovers() const;                      // what a killed run had half written

 private:
  std::filesystem::path folder_;
};

}  // namespace app
