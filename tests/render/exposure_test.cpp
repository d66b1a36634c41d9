// Means of many pictures: how the parts are spread, and what the whole shows.
#include "render/exposure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/mean.h"
#include "seen.h"

namespace render {
namespace {

Renderer& paper() {
  static Renderer shared({160, 120, Quality::kPaper, ""});
  return shared;
}

// A face that looks up gets as much from the points of the sky as from all of it: the mean of the
// cosine over the half sphere is 1/2.
TEST(Exposure, PointsOfTheSkyAndOfTheLightAreSpreadEvenly) {
  const std::vector<Exposure> all = spreadExposures(16);
  Eigen::Vector3f sky = Eigen::Vector3f::Zero();
  Eigen::Vector2f aside(0, 0), onLight(0, 0);
  for (const Exposure& one : all) {
    aside += one.aside / 16;
    onLight += one.onLight / 16;
    EXPECT_LE(one.aside.cwiseAbs().maxCoeff(), 0.5f);
    EXPECT_LE(one.onLight.norm(), 1.0f);
    for (const Eigen::Vector3f& toward : one.sky) {
      EXPECT_NEAR(toward.norm(), 1, 1e-6);
      sky += toward / (16 * kSkies);
    }
  }
  EXPECT_NEAR(sky.y(), 0.5, 1e-6);
  EXPECT_LT(std::hypot(sky.x(), sky.z()), 0.05);
  EXPECT_LT(aside.norm(), 0.1);
  EXPECT_LT(onLight.norm(), 0.1);
}

TEST(Mean, OfOnePictureManyTimesIsThatPicture) {
  std::vector<std::uint8_t> every(256), mean;
  for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<std::uint8_t>(i);
  for (const bool opaque : {true, false}) {
    Mean sum;
    sum.begin(opaque);
    for (int k = 0; k < 24; ++k) sum.add(every);
    sum.take(mean);
    EXPECT_EQ(mean, every) << opaque;
  }
}

// Of light, not of code values: black and white half the time are brighter than the middle grey.
TEST(Mean, IsOfLight) {
  std::vector<std::uint8_t> mean;
  Mean sum;
  sum.begin(true);
  sum.add({0});
  sum.add({255});
  sum.take(mean);
  EXPECT_EQ(mean[0], 180);  // 255 / sqrt(2) = 180.3
}

TEST(Paper, IsDarkerBetweenBodiesThanOnTop) {
  Picture picture = bare();
  picture.camera.eye = {0, 6, 0.1f};
  const Color grey(0.7f, 0.7f, 0.7f, 1);
  picture.instances = {box({4, 0.2f, 4}, {0, 0, 0}, grey)};
  const int open = at(paper().draw(picture), 80, 60).sum();
  picture.light.color = Vec3f::Zero();  // the sky alone
  const int sky = at(paper().draw(picture), 80, 60).sum();
  EXPECT_LT(sky, open);
  for (const float side : {-1.0f, 1.0f}) {
    picture.instances.push_back(box({0.6f, 2, 4}, {0.6f * side, 1, 0}, grey));
  }
  EXPECT_LT(at(paper().draw(picture), 80, 60).sum(), sky - 20);
}

TEST(Paper, ASofterLightHasAWiderShadowEdge) {
  Picture picture = bare();
  picture.ground.visible = true;
  picture.ground.spacing = 100;
  picture.camera.eye = {0, 6, 0.1f};
  picture.light.direction = {0, -1, 0};
  picture.instances = {box({1, 0.1f, 1}, {0, 1.5f, 0}, {0.5f, 0.5f, 0.5f, 1})};
  const auto shades = [&](float softness) {  // how many differ along a row across the edge
    picture.light.softness = softness;
    const Image image = paper().draw(picture);
    int count = 0;
    for (int x = 100; x < 150; ++x) {
      count += std::abs(at(image, x, 60).sum() - at(image, x + 1, 60).sum()) > 6 ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(shades(0.3f), shades(0.01f));
}

TEST(Shutter, BlursWhatMovesAndLeavesTheRest) {
  Picture still = bare();
  still.instances = {box({0.5f, 0.5f, 0.5f}, {-1, 0, 0}, kRed),
                     box({0.5f, 0.5f, 0.5f}, {1, 0.5f, 0}, kBlack)};
  Picture moved = still;
  moved.instances[1].position.y() = -0.5f;
  const Image once = renderer().draw(still);
  const Image both = renderer().draw(std::vector<Picture>{still, moved});
  EXPECT_EQ(at(both, 51, 60).sum(), at(once, 51, 60).sum());
  const int body = at(once, 109, 45).sum(), blurred = at(both, 109, 45).sum();
  EXPECT_GT(blurred, body + 100);
  EXPECT_LT(blurred, 3 * 255 - 100);
  EXPECT_EQ(renderer().draw(std::vector<Picture>{still, still}), once);
}

TEST(Background, IsTransparentOnRequest) {
  Picture picture = bare();
  picture.background = {1, 1, 1, 0};
  picture.instances = {box({1, 1, 1}, {0, 0, 0}, kRed)};
  const Image image = renderer().draw(picture);
  ASSERT_EQ(image.alpha.size(), 160u * 120u);
  EXPECT_EQ(image.alpha[0], 0);
  EXPECT_EQ(image.alpha[60 * 160 + 80], 255);
  picture.background.w() = 1;
  EXPECT_TRUE(renderer().draw(picture).alpha.empty());
}

// Alone over nothing, the ground is what it takes from the light.
TEST(Background, TransparentGroundIsItsShadow) {
  Picture picture = bare();
  picture.background = {1, 1, 1, 0};
  picture.ground.visible = true;
  picture.ground.spacing = 100;
  picture.camera.eye = {0, 6, 0.1f};
  picture.light.direction = {1, -1, 0};
  EXPECT_EQ(renderer().draw(picture).alpha[40 * 160 + 60], 0);  // away from lines
  picture.instances = {box({1, 0.5f, 1}, {0, 0.25f, 0}, kBlack)};
  const Image image = renderer().draw(picture);
  const std::size_t inShadow = 60 * 160 + 97;
  EXPECT_GT(image.alpha[inShadow], 60);
  EXPECT_LT(image.alpha[inShadow], 200);
  EXPECT_EQ(image.rgb[3 * inShadow], 0);
}

}  // namespace
}  // namespace render
