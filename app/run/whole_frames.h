// Frames of several cells that are drawn in any order: whole ones come out in theirs.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "render/image.h"

namespace app {

class WholeFrames {
 public:
  // By cell of a frame, whether it is drawn; the others stay empty images.
  explicit WholeFrames(std::vector<bool> isDrawn);

  int job(int frame, int cell) const { return frame * cells() + cell; }
  void take(int job, const render::Image& image);  // from any thread

  // The cells of the frame after the last that came out; nothing while one is missing.
  std::optional<std::vector<render::Image>> next();

 private:
  int cells() const { return static_cast<int>(isDrawn_.size()); }

  std::vector<bool> isDrawn_;
  std::mutex mutex_;
  std::map<int, render::Image> done_;  // by job
  int frame_ = 0;
};

}  // namespace app
