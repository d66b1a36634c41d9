// Shadows on the ground and on bodies, and what the ground hides.
#include <gtest/gtest.h>

#include "seen.h"

namespace render {
namespace {

TEST(Ground, HidesWhatIsBelowItAndTakesShadow) {
  Picture picture = bare();
  picture.ground.visible = true;
  picture.ground.spacing = 100;
  picture.camera.eye = {0, 6, 0.1f};
  picture.light.direction = {-0.5f, -1, 0};
  const Rgb empty = at(renderer().draw(picture), 60, 60);
  picture.instances = {box({1, 0.5f, 1}, {-0.8f, -1, 0}, kBlack)};
  EXPECT_EQ(at(renderer().draw(picture), 60, 60).sum(), empty.sum());
  picture.instances = {box({1, 0.1f, 1}, {0.3f, 1.5f, 0}, kBlack)};
  EXPECT_LT(at(renderer().draw(picture), 60, 60).sum(), empty.sum() - 60);
  picture.light.shadows = false;
  EXPECT_EQ(at(renderer().draw(picture), 60, 60).sum(), empty.sum());
}

TEST(Shadow, FallsOnOtherBodiesAndNotOnTheBodyItself) {
  Picture picture = bare();
  picture.camera.eye = {0, 6, 0.1f};
  picture.light.direction = {0, -1, 0};
  picture.instances = {box({2, 0.2f, 2}, {0, 0, 0}, {0.7f, 0.7f, 0.7f, 1})};
  picture.light.shadows = false;
  const Image unshaded = renderer().draw(picture);
  picture.light.shadows = true;
  EXPECT_EQ(unshaded, renderer().draw(picture));  // no acne
  picture.light.direction = {1, -1, 0};
  const Rgb before = at(renderer().draw(picture), 80, 60);
  picture.instances.push_back(box({0.6f, 0.1f, 0.6f}, {-1, 1.1f, 0}, kRed));
  EXPECT_LT(at(renderer().draw(picture), 80, 60).sum(), before.sum() - 60);
}

TEST(Shadow, OfABodyOnTheGroundBeginsWhereTheyTouch) {
  Picture picture = bare();
  picture.ground.visible = true;
  picture.ground.spacing = 100;
  picture.camera.eye = {0, 6, 0.1f};
  picture.light.direction = {1, -1, 0};
  const Rgb empty = at(renderer().draw(picture), 60, 60);
  picture.instances = {box({1, 0.5f, 1}, {0, 0.25f, 0}, kBlack)};
  // The box ends at x = 0.5 m, which is 27 px per metre from the middle on the ground.
  EXPECT_LT(at(renderer().draw(picture), 80 + 17, 60).sum(), empty.sum() - 60);
  EXPECT_GT(at(renderer().draw(picture), 80 - 20, 60).sum(), empty.sum() - 60);
}

TEST(Shadow, OfACasterFarAboveTheFocusStillFalls) {
  Picture picture = bare();
  picture.ground.visible = true;
  picture.ground.spacing = 100;
  picture.camera.eye = {3, 6, 0.1f};
  picture.camera.target = {0, 0, 0};
  picture.light.direction = {0, -1, 0};
  const Rgb empty = at(renderer().draw(picture), 80, 60);
  picture.instances = {box({1.5f, 0.1f, 1.5f}, {0, 40, 0}, kBlack)};
  EXPECT_LT(at(renderer().draw(picture), 80, 60).sum(), empty.sum() - 60);
}

TEST(Shadow, BeyondTheMapNothingIsInShadow) {
  Picture picture = bare();
  picture.focusRadius = 1;
  picture.camera.eye = {0, 6, 0.1f};
  picture.light.direction = {1, -1, 0.5f};
  picture.instances = {box({12, 0.2f, 12}, {0, 0, 0}, {0.7f, 0.7f, 0.7f, 1})};
  const Image shaded = renderer().draw(picture);
  picture.light.shadows = false;
  EXPECT_EQ(renderer().draw(picture), shaded);
}

// 27 px are a metre of the ground: the box and its shadow end within 2 m of the middle.
TEST(Shadow, OfACasterAcrossTheBorderOfTheMapEndsThere) {
  Picture picture = bare();
  picture.ground.visible = true;
  picture.ground.spacing = 100;
  picture.focusRadius = 1;
  picture.camera.eye = {0, 6, 0.1f};
  picture.light.direction = {0.2f, -1, 0};
  const Image empty = renderer().draw(picture);
  picture.instances = {box({3, 0.3f, 3}, {0, 0.15f, 0}, kBlack)};
  const Image shaded = renderer().draw(picture);
  for (const int x : {10, 150}) {
    for (int y = 10; y < 120; y += 10) EXPECT_EQ(at(shaded, x, y).sum(), at(empty, x, y).sum());
  }
}

}  // namespace
}  // namespace render
