// Cells wait until their frame is whole.
#include "app/run/whole_frames.h"

#include <utility>

namespace app {

WholeFrames::WholeFrames(std::vector<bool> isDrawn) : isDrawn_(std::move(isDrawn)) {}

void WholeFrames::take(int job, const render::Image& image) {
  const std::lock_guard lock(mutex_);
  done_[job] = image;
}

std::optional<std::vector<render::Image>> WholeFrames::next() {
  const std::lock_guard lock(mutex_);
  for (int cell = 0; cell < cells(); ++cell) {
    if (isDrawn_[cell] && !done_.contains(job(frame_, cell))) return std::nullopt;
  }
  std::vector<render::Image> images(isDrawn_.size());
  for (int cell = 0; cell < cells(); ++cell) {
    auto image = done_.extract(job(frame_, cell));
    if (!image.empty()) images[cell] = std::move(image.mapped());
  }
  ++frame_;
  return images;
}

}  // namespace app
