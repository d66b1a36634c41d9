// Pictures in, images out, on as many threads as asked.
#include "app/run/pipeline.h"

#include <utility>

#include "app/base/stopwatch.h"
#include "app/run/open_renderer.h"

namespace app {

Pipeline::Pipeline(const render::RendererOptions& options, int workers, Sink sink)
    : sink_(std::move(sink)), queue_(static_cast<std::size_t>(2 * workers)) {
  for (int i = 0; i < workers; ++i) workers_.emplace_back([this, options] { work(options); });
}

Pipeline::~Pipeline() {
  queue_.close(true);
  join();
}

void Pipeline::draw(int frame, render::Picture picture) {
  if (!queue_.push({frame, std::move(picture)})) finish();
}

void Pipeline::finish() {
  queue_.close();
  join();
  if (failure_) std::rethrow_exception(failure_);
}

void Pipeline::abandon() {
  queue_.close(true);
  join();
  if (failure_) std::rethrow_exception(failure_);
}

DrawSeconds Pipeline::seconds() const {
  const std::lock_guard lock(mutex_);
  return seconds_;
}

void Pipeline::work(const render::RendererOptions& options) {
  try {
    const std::unique_ptr<render::Renderer> renderer = openRenderer(options);
    while (const std::optional<Job> job = queue_.pop()) {
      Stopwatch watch;
      const render::Image& image = drawFrame(*renderer, job->frame, {&job->picture, 1});
      const double draw = watch.lap();
      sink_(job->frame, image);
      const std::lock_guard lock(mutex_);
      seconds_.draw += draw;
      seconds_.write += watch.lap();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
    queue_.close(true);
  }
}

void Pipeline::join() {
  for (std::thread& worker : workers_) {
    if (worker.joinable()) worker.join();
  }
}

}  // namespace app
