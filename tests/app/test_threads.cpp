// What runs on several threads: simulations at the same time, and one on several. The thread
// sanitizer builds nothing else.
#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "scenes/simulation.h"

namespace app {
namespace {

std::uint64_t hashAfter(const std::string& scene, int frames, int threads = 1) {
  scenes::Simulation simulation(scenes::readScene(scene));
  simulation.setThreads(threads);
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

TEST(Simulations, OneOnSeveralThreadsIsAsOnOne) {
  for (const char* scene : {"pyramid", "mixed_shapes"}) {
    EXPECT_EQ(hashAfter(scene, 20, 3), hashAfter(scene, 20)) << scene;
  }
}

}  // namespace
}  // namespace app
