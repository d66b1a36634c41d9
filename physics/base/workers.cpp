// The pool: one claim a thread, {round, next chunk, end} in one word, so that a thread which wakes
// too late finds nothing of an earlier round.
#include "physics/base/workers.h"

#include <immintrin.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace physics {
namespace {

constexpr int kChunksPerThread = 4;  // who comes late leaves an eighth undone, not a half
constexpr int kPatience = 1 << 13;   // looks before sleep, some 150 us: as long as waking takes

std::uint64_t claimOf(std::uint32_t round, int next, int end) {
  return std::uint64_t{round} << 32 | static_cast<std::uint64_t>(next) << 16 |
         static_cast<std::uint64_t>(end);
}

}  // namespace

struct Workers::Impl {
  struct alignas(64) Claim {
    std::atomic<std::uint64_t> word{0};
  };
  std::vector<Claim> claims;
  std::vector<std::thread> others;
  alignas(64) std::atomic<std::uint32_t> round{0};
  alignas(64) std::atomic<int> open{0};  // chunks that are not done
  alignas(64) std::atomic<bool> stop{false};
  Call call = nullptr;  // of this round; read by who holds a chunk of it
  void* f = nullptr;
  int items = 0, chunks = 0;

  explicit Impl(int threads) : claims(threads) {
    for (int t = 1; t < threads; ++t) others.emplace_back([this, t] { work(t); });
  }

  ~Impl() {
    stop = true;
    ++round;
    round.notify_all();
    for (std::thread& other : others) other.join();
  }

  // One chunk of those dealt to thread t. False: there is none.
  bool takeOne(std::uint32_t now, std::size_t t) {
    std::atomic<std::uint64_t>& word = claims[t].word;
    std::uint64_t seen = word.load(std::memory_order_acquire);
    int next = 0;
    do {
      next = static_cast<int>(seen >> 16 & 0xffff);
      if (static_cast<std::uint32_t>(seen >> 32) != now ||
          next >= static_cast<int>(seen & 0xffff)) {
        return false;
      }
    } while (!word.compare_exchange_weak(seen, seen + (1u << 16), std::memory_order_acq_rel));
    const auto startOf = [&](int chunk) {
      return static_cast<int>(std::int64_t{items} * chunk / chunks);
    };
    call(f, startOf(next), startOf(next + 1));
    open.fetch_sub(1, std::memory_order_release);
    return true;
  }

  void takeAll(std::uint32_t now, std::size_t self) {
    for (std::size_t k = 0; k < claims.size(); ++k) {
      while (takeOne(now, (self + k) % claims.size())) {
      }
    }
  }

  void work(std::size_t self) {
    std::uint32_t seen = 0;
    while (!stop.load(std::memory_order_relaxed)) {
      const std::uint32_t now = waitFor(seen);
      takeAll(now, self);
      seen = now;
    }
  }

  // A round after `seen`.
  std::uint32_t waitFor(std::uint32_t seen) {
    for (int k = 0; k < kPatience; ++k) {
      const std::uint32_t now = round.load(std::memory_order_acquire);
      if (now != seen) return now;
      _mm_pause();
    }
    round.wait(seen, std::memory_order_acquire);
    return round.load(std::memory_order_acquire);
  }
};

Workers::Workers() = default;
Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

int Workers::count() const { return impl_ ? static_cast<int>(impl_->claims.size()) : 1; }

void Workers::setCount(int threads) {
  if (threads < 1) {
    throw std::invalid_argument("at least one thread, not " + std::to_string(threads));
  }
  if (threads == count()) return;
  impl_.reset();
  if (threads > 1) impl_ = std::make_unique<Impl>(threads);
}

void Workers::run(int items, int least, Call call, void* f) {
  Impl& w = *impl_;
  const int threads = static_cast<int>(w.claims.size());
  w.call = call;
  w.f = f;
  w.items = items;
  w.chunks = std::min(items / least, kChunksPerThread * threads);
  w.open.store(w.chunks, std::memory_order_relaxed);
  const std::uint32_t now = w.round.load(std::memory_order_relaxed) + 1;
  for (int t = 0; t < threads; ++t) {
    w.claims[t].word.store(claimOf(now, w.chunks * t / threads, w.chunks * (t + 1) / threads),
                           std::memory_order_release);
  }
  w.round.store(now, std::memory_order_release);
  w.round.notify_all();
  w.takeAll(now, 0);
  while (w.open.load(std::memory_order_acquire) != 0) _mm_pause();
}

}  // namespace physics
