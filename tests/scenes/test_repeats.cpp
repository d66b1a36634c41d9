// The same scene gives the same state, a hundred times over, whatever fresh memory holds.
#include <gtest/gtest.h>
#include <malloc.h>

#include "scenes/simulation.h"

namespace scenes {
namespace {

constexpr int kRepeats = 100, kFrames = 4;

std::uint64_t hashOf(const Scene& scene, int frames) {
  Simulation simulation(scene);
  for (int k = 0; k < frames; ++k) EXPECT_FALSE(simulation.advance().notFinite);
  return simulation.stateHash();
}

class Repeats : public testing::TestWithParam<const char*> {
 protected:
  void TearDown() override { mallopt(M_PERTURB, 0); }
};

TEST_P(Repeats, HaveTheSameStateHash) {
  const Scene scene = readScene(GetParam());
  const std::uint64_t first = hashOf(scene, kFrames);
  for (int k = 1; k <= kRepeats; ++k) {
    mallopt(M_PERTURB, k);  // what malloc hands out is filled with another byte each time
    ASSERT_EQ(hashOf(scene, kFrames), first) << "repeat " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Repeats,
                         testing::Values("arch", "arm_reach", "chain", "heavy_chain", "incline",
                                         "mixed_shapes", "pendulum", "ragdoll_drive", "rope_swing",
                                         "spinning_tops", "squashed_tet", "stack", "stiff_springs"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(Repeats, OfEveryMethodHaveTheSameStateHash) {
  for (const char* method : {"nonlinear_gauss_seidel", "direct", "linear_gauss_seidel", "xpbd",
                             "sequential_impulses", "penalty", "penalty_explicit"}) {
    const std::vector<std::string> set{std::string("simulation.method=") + method};
    const Scene scene = readScene("mixed_shapes", set);
    const std::uint64_t first = hashOf(scene, kFrames);
    for (int k = 1; k <= 10; ++k) {
      mallopt(M_PERTURB, 20 * k);
      EXPECT_EQ(hashOf(scene, kFrames), first) << method;
    }
    mallopt(M_PERTURB, 0);
  }
}

}  // namespace
}  // namespace scenes
