// What is shown of a kept frame is what was there, to the last bit.
#include <gtest/gtest.h>

#include <cstring>

#include "render/picture_hash.h"
#include "scenes/moment.h"
#include "scenes/view/view.h"

namespace scenes {
namespace {

bool sameBits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

render::Picture pictureNow(const Simulation& simulation) {
  MotionBounds bounds;
  bounds.include(simulation);
  ViewOptions options;
  options.hud = true;
  options.overlays = {true, true, true, true, true, true, true, true, true};
  return view(simulation, bounds, options, {simulation.metrics()});
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, IsShownAsItWasByAnotherSimulation) {
  const Scene scene = readScene(GetParam());
  Simulation stepped(scene), other(scene);
  const Moment start = other.moment();
  for (int k = 0; k < 7; ++k) stepped.advance();
  const Moment kept = stepped.moment();
  const MomentNumbers numbers = numbersOf(kept);
  Moment read = momentFrom(numbers, start);
  read.frame = read.metrics.frame = kept.frame;
  read.metrics.time = kept.metrics.time;
  read.stateHash = kept.stateHash;
  ASSERT_TRUE(other.show(read));
  for (physics::BodyId b = 0; b < other.world().bodyCount(); ++b) {
    const physics::Pose &is = other.world().bodies().pose[b], &was = kept.poses[b];
    ASSERT_EQ(is.x, was.x) << b;
    ASSERT_EQ(is.q.coeffs(), was.q.coeffs()) << b;
  }
  const MomentNumbers again = numbersOf(other.moment());
  EXPECT_TRUE(sameBits(again.poses, numbers.poses));
  EXPECT_TRUE(sameBits(again.velocities, numbers.velocities));
  EXPECT_TRUE(sameBits(again.contacts, numbers.contacts));
  EXPECT_TRUE(sameBits(again.arms, numbers.arms));
  EXPECT_TRUE(sameBits(again.metrics, numbers.metrics));
  EXPECT_EQ(numbers.metrics.size(), numberNames(kept.metrics).size());
  EXPECT_EQ(other.stateHash(), stepped.stateHash());
  EXPECT_EQ(render::pictureHash(pictureNow(other)), render::pictureHash(pictureNow(stepped)));
}
INSTANTIATE_TEST_SUITE_P(Library, EveryScene, testing::ValuesIn(libraryScenes()));

TEST(Moment, OfAnotherNumberOfBodiesOrNotFiniteIsNotShown) {
  Simulation simulation(readScene("pendulum"));
  Moment moment = simulation.moment();
  moment.frame = 5;
  moment.poses[1].x.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(simulation.show(moment));
  moment = simulation.moment();
  moment.poses.pop_back();
  EXPECT_FALSE(simulation.show(moment));
  EXPECT_EQ(simulation.frame(), 0);
}

}  // namespace
}  // namespace scenes
