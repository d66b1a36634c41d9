// Independent tasks on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace app {

// Calls task(0) ... task(count-1), each once, begun in this order. False from a task lets no other
// begin. Throws the first exception that a task threw. Tells whether all were done.
inline bool runTasks(int count, int threads, const std::function<bool(int)>& task) {
  std::atomic<int> next{0};
  std::atomic<bool> stopped{false};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    try {
      for (int i = next++; i < count && !stopped; i = next++) {
        if (!task(i)) stopped = true;
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      stopped = true;
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < std::min(threads, count); ++i) others.emplace_back(work);
  work();
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
  return !stopped;
}

}  // namespace app
