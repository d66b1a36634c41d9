// Threads that share the parts of a step which do not depend on each other.
//
// Items are dealt in chunks, first its own to each thread, so that it meets the same data again;
// who is done takes from the others. What a chunk does may depend on its items alone: then the
// bytes are the same on any number of threads. Threads that are given nothing spin for a moment,
// then sleep; no call waits for one that has not begun.
#pragma once

#include <memory>
#include <type_traits>

namespace physics {

class Workers {
 public:
  Workers();
  ~Workers();
  Workers(Workers&&) noexcept;
  Workers& operator=(Workers&&) noexcept;

  // The caller's thread is one of them. Throws std::invalid_argument below 1.
  void setCount(int threads);
  int count() const;

  // f(from, to) of chunks that make up [0, items), none under `least` items; all at once on the
  // caller's thread where that makes one chunk.
  template <class F>
  void forEachChunk(int items, int least, F&& f) {
    if (items <= 0) return;
    if (count() == 1 || items < 2 * least) return f(0, items);
    using Function = std::remove_reference_t<F>;
    run(
        items, least,
        [](void* call, int from, int to) { (*static_cast<Function*>(call))(from, to); },
        const_cast<void*>(static_cast<const void*>(&f)));
  }

 private:
  using Call = void (*)(void* f, int from, int to);
  void run(int items, int least, Call call, void* f);
  struct Impl;
  std::unique_ptr<Impl> impl_;  // none: one thread
};

}  // namespace physics
