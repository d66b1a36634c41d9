// Pictures in, images out, on as many threads as asked: drawing and writing overlap with whoever
// makes the pictures.
#pragma once

#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "app/base/bounded_queue.h"
#include "render/picture.h"
#include "render/renderer.h"

namespace app {

struct DrawSeconds {
  double draw = 0, write = 0;  // summed over the threads
};

class Pipeline {
 public:
  // Called on a worker thread, in any order, never twice for one frame.
  using Sink = std::function<void(int frame, const render::Image& image)>;

  Pipeline(const render::RendererOptions& options, int workers, Sink sink);
  ~Pipeline();  // abandons what is queued
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  // Waits while every worker is busy and the queue is full. Throws what a worker threw.
  void draw(int frame, render::Picture picture);

  void finish();   // returns when all is drawn; throws what a worker threw
  void abandon();  // finishes the frames in work and drops the others; throws what a worker threw

  DrawSeconds seconds() const;  // after finish() or abandon()

 private:
  struct Job {
    int frame = 0;
    render::Picture picture;
  };
  void work(const render::RendererOptions& options);
  void join();

  Sink sink_;
  BoundedQueue<Job> queue_;
  std::vector<std::thread> workers_;
  mutable std::mutex mutex_;  // of the two below
  std::exception_ptr failure_;
  DrawSeconds seconds_;
};

}  // namespace app
