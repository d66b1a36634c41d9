// What runs on several threads: the queue, the pipeline that draws, simulations at the same time.
// The thread sanitizer builds nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <set>
#include <thread>

#include "app/commands/exit_code.h"
#include "app/run/pipeline.h"
#include "scenes/simulation.h"
#include "tests/render/sample.h"

namespace app {
namespace {

TEST(BoundedQueue, HandsEveryItemToOneConsumer) {
  BoundedQueue<int> queue(3);
  constexpr int kItems = 2000, kConsumers = 4;
  std::vector<std::vector<int>> got(kConsumers);
  std::vector<std::thread> consumers;
  for (std::vector<int>& mine : got) {
    consumers.emplace_back([&queue, &mine] {
      while (const std::optional<int> item = queue.pop()) mine.push_back(*item);
    });
  }
  for (int i = 0; i < kItems; ++i) EXPECT_TRUE(queue.push(i));
  queue.close();
  for (std::thread& consumer : consumers) consumer.join();
  std::multiset<int> all;
  for (const std::vector<int>& mine : got) {
    EXPECT_TRUE(std::is_sorted(mine.begin(), mine.end()));
    all.insert(mine.begin(), mine.end());
  }
  std::vector<int> wanted(kItems);
  std::iota(wanted.begin(), wanted.end(), 0);
  EXPECT_TRUE(std::equal(all.begin(), all.end(), wanted.begin(), wanted.end()));
}

TEST(BoundedQueue, ClosingWakesWhoWaits) {
  BoundedQueue<int> full(1), empty(1);
  ASSERT_TRUE(full.push(1));
  std::thread producer([&] { EXPECT_FALSE(full.push(2)); });
  std::thread consumer([&] { EXPECT_FALSE(empty.pop()); });
  full.close(true);
  empty.close();
  producer.join();
  consumer.join();
  EXPECT_FALSE(full.pop());
}

render::RendererOptions small() { return {64, 36, render::Quality::kDraft, ""}; }

TEST(Pipeline, DrawsEveryFrameOnceAndTheSameOnAnyThread) {
  setenv("LP_NUM_THREADS", "0", 1);
  std::vector<std::vector<std::uint8_t>> frames(24);
  std::atomic<int> drawn{0};
  Pipeline pipeline(small(), 3, [&](int frame, const render::Image& image) {
    frames[static_cast<std::size_t>(frame)] = image.rgb;
    ++drawn;
  });
  for (int frame = 0; frame < 24; ++frame) pipeline.draw(frame, render::samplePicture());
  pipeline.finish();
  EXPECT_EQ(drawn, 24);
  for (const auto& pixels : frames) EXPECT_EQ(pixels, frames[0]);
  EXPECT_GT(pipeline.seconds().draw, 0);
}

TEST(Pipeline, TellsWhatAWorkerThrew) {
  Pipeline pipeline(small(), 2, [](int frame, const render::Image&) {
    if (frame == 5) throw EnvironmentError("no space");
  });
  EXPECT_THROW(
      {
        for (int frame = 0; frame < 40; ++frame) pipeline.draw(frame, render::samplePicture());
        pipeline.finish();
      },
      EnvironmentError);
}

TEST(Pipeline, NamesAFrameThatCannotBeDrawn) {
  Pipeline pipeline(small(), 2, [](int, const render::Image&) {});
  render::Picture picture = render::samplePicture();
  picture.instances[0].position.x() = std::numeric_limits<float>::infinity();
  pipeline.draw(3, picture);
  try {
    pipeline.finish();
    FAIL() << "it was drawn";
  } catch (const CheckFailed& error) {
    EXPECT_EQ(std::string(error.what()).rfind("frame 3 cannot be drawn: ", 0), 0u) << error.what();
  }
}

std::uint64_t hashAfter(const std::string& scene, int frames) {
  scenes::Simulation simulation(scenes::readScene(scene));
  for (int k = 0; k < frames; ++k) simulation.advance();
  return simulation.stateHash();
}

// As studies do: two runs of one process at the same time.
TEST(Simulations, AtTheSameTimeAreAsOneAfterTheOther) {
  const std::vector<std::string> names = {"chain", "mixed_shapes", "cloth_hang", "arm_reach"};
  for (const std::string& name : names) {
    const std::uint64_t alone = hashAfter(name, 20);
    std::array<std::uint64_t, 2> together{};
    std::array<std::thread, 2> threads;
    for (int k = 0; k < 2; ++k) {
      threads[k] = std::thread([&, k] { together[k] = hashAfter(name, 20); });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(together[0], alone) << name;
    EXPECT_EQ(together[1], alone) << name;
  }
}

TEST(Pipeline, AbandoningDropsWhatWaits) {
  std::atomic<int> drawn{0};
  Pipeline pipeline(small(), 2, [&](int, const render::Image&) { ++drawn; });
  for (int frame = 0; frame < 3; ++frame) pipeline.draw(frame, render::samplePicture());
  pipeline.abandon();
  EXPECT_LE(drawn, 3);
}

}  // namespace
}  // namespace app
