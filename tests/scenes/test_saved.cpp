// A simulation that restores what another one saved goes on as that one, to the last bit.
#include <gtest/gtest.h>

#include <sstream>

#include "physics/base/archive.h"
#include "scenes/moment.h"
#include "scenes/study/stability_case.h"

namespace scenes {
namespace {

std::string saved(Simulation& simulation, Checker& checker) {
  std::string bytes;
  physics::Archive archive(bytes);
  archive(simulation, checker);
  return bytes;
}

struct Stepped {
  Simulation simulation;
  Checker checker;
  explicit Stepped(const Scene& scene) : simulation(scene), checker(scene) {}
  std::string saved() { return scenes::saved(simulation, checker); }
  void restore(const std::string& bytes) {
    physics::Archive archive{std::string_view(bytes)};
    archive(simulation, checker);
    ASSERT_TRUE(archive.isAtEnd());
  }
  void advance(int frames) {
    for (int k = 0; k < frames; ++k) {
      simulation.advance();
      checker.observe(simulation);
    }
  }
};

// What is saved has all that the next step reads, so that equal bytes are equal states, but nothing
// of how they came about.
void expectGoesOn(const Scene& scene, int before, int after) {
  Stepped undisturbed(scene), resumed(scene);
  undisturbed.checker.observe(undisturbed.simulation);
  undisturbed.advance(before);
  const std::string bytes = undisturbed.saved();
  resumed.restore(bytes);
  EXPECT_EQ(resumed.saved(), bytes);
  for (int k = 0; k < after; ++k) {
    undisturbed.advance(1);
    resumed.advance(1);
    ASSERT_EQ(resumed.simulation.stateHash(), undisturbed.simulation.stateHash()) << "frame " << k;
    const MomentNumbers is = numbersOf(resumed.simulation.moment());
    const MomentNumbers was = numbersOf(undisturbed.simulation.moment());
    ASSERT_EQ(is.metrics, was.metrics) << "frame " << k;
    ASSERT_EQ(is.contacts, was.contacts) << "frame " << k;
    ASSERT_EQ(is.arms, was.arms) << "frame " << k;
    ASSERT_TRUE(resumed.saved() == undisturbed.saved()) << "frame " << k;
  }
  const auto is = resumed.checker.verdicts(), was = undisturbed.checker.verdicts();
  for (std::size_t i = 0; i < was.size(); ++i) EXPECT_EQ(is[i].text, was[i].text);
}

class EverySavedScene : public testing::TestWithParam<std::string> {};

TEST_P(EverySavedScene, GoesOnAsIfItHadNotStopped) {
  for (const int frames : {0, 1, 12}) expectGoesOn(readScene(GetParam()), frames, 5);
}
INSTANTIATE_TEST_SUITE_P(Library, EverySavedScene, testing::ValuesIn(libraryScenes()));

using Case = std::tuple<std::string, std::string>;  // scene, overrides
class EverySavedMethod : public testing::TestWithParam<Case> {};

TEST_P(EverySavedMethod, GoesOnAsIfItHadNotStopped) {
  const auto& [name, words] = GetParam();
  std::vector<std::string> overrides;
  std::istringstream all("simulation." + words);
  for (std::string word; all >> word;) overrides.push_back(word);
  expectGoesOn(readScene(name, overrides), 9, 6);
}
INSTANTIATE_TEST_SUITE_P(
    Library, EverySavedMethod,
    testing::Combine(
        testing::Values("chain", "stack", "wrecking_ball", "spring_net", "ragdoll_stairs",
                        "rolling", "spinning_tops", "rope_swing"),
        testing::Values("method=nonlinear_gauss_seidel", "method=direct",
                        "method=linear_gauss_seidel", "method=xpbd", "method=sequential_impulses",
                        "method=penalty", "stepping=bdf2", "stepping=symmetric",
                        "method=direct simulation.stepping=bdf2", "accuracy=1e-3", "accuracy=1e-2",
                        "local_substeps=true simulation.method=nonlinear_gauss_seidel")));

class EverySavedHardCase : public testing::TestWithParam<std::string> {};

// Of those that are quick.
TEST_P(EverySavedHardCase, GoesOnAsIfItHadNotStopped) {
  const Scene scene = stabilityScene(readStabilityCases(GetParam()).front(), {});
  if (Simulation(scene).world().bodyCount() > 500) GTEST_SKIP() << "it takes long";
  expectGoesOn(scene, 5, 4);
}
INSTANTIATE_TEST_SUITE_P(Stability, EverySavedHardCase, testing::ValuesIn(stabilityFiles()));

// Until bodies have fallen asleep, and some of them are woken.
TEST(SavedScene, GoesOnFromWhereBodiesSleep) {
  for (const char* name : {"stack", "dominoes", "card_house", "cloth_drop"}) {
    const Scene scene =
        readScene(name, std::vector<std::string>{"sleep.speed=0.05", "sleep.time=0.1"});
    for (const int frames : {15, 40, 70}) expectGoesOn(scene, frames, 4);
  }
}

TEST(SavedScene, IsNotRestoredByAnother) {
  Stepped chain(readScene("chain")), stack(readScene("stack"));
  const std::string whole = chain.saved();
  physics::Archive archive{std::string_view(whole)};
  EXPECT_THROW(archive(stack.simulation), std::invalid_argument);
  Stepped again(readScene("chain"));
  physics::Archive torn(std::string_view(whole).substr(0, whole.size() / 2));
  EXPECT_THROW(torn(again.simulation), std::invalid_argument);
}

}  // namespace
}  // namespace scenes
