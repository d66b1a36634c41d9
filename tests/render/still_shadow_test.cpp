// What stands still is not drawn into the shadow map again, what was not asked for is not drawn at
// all, and the picture is the same, bit for bit.
#include <gtest/gtest.h>

#include "render/still_casters.h"
#include "sample.h"
#include "seen.h"

namespace render {
namespace {

constexpr int kStill = 40;

std::vector<Caster> casters(int count) {
  std::vector<Caster> all(count);
  for (int i = 0; i < count; ++i) all[i].place = {static_cast<float>(i), 0, 0, 0};
  return all;
}

TEST(StillCasters, NothingIsDrawnWhereNothingMoved) {
  StillCasters still;
  EXPECT_EQ(still.next(casters(kStill), {}, false).moving.size(), 40u);
  EXPECT_TRUE(still.next(casters(kStill), {}, false).nothing);
}

TEST(StillCasters, OnlyWhatMovesIsDrawnOverTheLayer) {
  StillCasters still;
  std::vector<Caster> all = casters(kStill);
  still.next(all, {}, false);
  for (int k = 0; k < 3; ++k) {
    all[7].place[1] += 1;
    const ShadowWork work = still.next(all, {}, false);
    EXPECT_EQ(work.newLayer, k == 0);
    EXPECT_TRUE(work.fromLayer);
    EXPECT_EQ(work.moving, std::vector<std::size_t>{7});
  }
}

TEST(StillCasters, ABodyOfTheLayerThatMovesEndsIt) {
  StillCasters still;
  std::vector<Caster> all = casters(kStill);
  for (int k = 0; k < 3; ++k) {
    all[7].place[1] += 1;
    still.next(all, {}, false);
  }
  all[8].place[1] = 1;
  const ShadowWork work = still.next(all, {}, false);
  EXPECT_TRUE(work.newLayer);
  EXPECT_EQ(work.moving, std::vector<std::size_t>{8});  // 7 stood still by now
}

TEST(StillCasters, AnotherLightAnotherGeometryAndFewerBodiesEndTheLayer) {
  std::vector<Caster> all = casters(kStill);
  ShadowView turned{};
  turned[0] = 1;
  std::vector<Caster> other = all;
  for (Caster& caster : other) caster.upload = 9;
  for (const auto& [now, view] :
       {std::pair(all, turned), std::pair(other, ShadowView{}), std::pair(casters(5), turned)}) {
    StillCasters still;
    still.next(all, {}, false);
    all[7].place[1] += 1;
    still.next(all, {}, false);
    const ShadowWork work = still.next(now, view, false);
    EXPECT_FALSE(work.fromLayer);
    EXPECT_EQ(work.moving.size(), now.size());
  }
}

TEST(StillCasters, FewBodiesAndMovingOnesNeedNoLayer) {
  StillCasters still;
  std::vector<Caster> all = casters(kStill);
  for (int k = 0; k < 3; ++k) {
    for (Caster& caster : all) caster.place[1] += 1;
    EXPECT_FALSE(still.next(all, {}, false).fromLayer);
  }
  StillCasters few;
  few.next(casters(5), {}, true);
  EXPECT_FALSE(few.next(casters(5), {}, true).fromLayer);
}

// Pictures in which bodies begin and cease to move, come and go.
std::vector<Picture> story() {
  std::vector<Picture> pictures(9, pyramidPicture(8));
  for (int k = 0; k < 9; ++k) pictures[k].instances[3].position.y() += 0.2f * static_cast<float>(k);
  for (int k = 4; k < 9; ++k) pictures[k].instances[9].position.x() += 0.5f;
  pictures[5].light.direction.x() += 0.3f;
  pictures[6].ground.visible = false;
  pictures[7] = clothPicture(20);
  pictures[8].instances.erase(pictures[8].instances.begin(), pictures[8].instances.begin() + 20);
  return pictures;
}

class StillShadow : public ::testing::TestWithParam<Quality> {};

TEST_P(StillShadow, PicturesAreTheSameBitForBitAsDrawnAnew) {
  const RendererOptions options{160, 90, GetParam(), ""};
  Renderer used(options);
  for (const Picture& picture : story()) {
    EXPECT_EQ(Renderer(options).draw(picture), used.draw(picture));
  }
}

INSTANTIATE_TEST_SUITE_P(Qualities, StillShadow,
                         ::testing::Values(Quality::kDraft, Quality::kStandard, Quality::kPaper));

TEST(DrawCounts, OneOfManyBodiesMovesAndOneIsDrawn) {
  Renderer renderer({64, 64, Quality::kDraft, ""});
  Picture picture = pyramidPicture(8);  // 36 boxes
  const auto drawNext = [&] {
    const DrawCounts before = renderer.counts();
    picture.instances[3].position.y() += 0.1f;
    renderer.draw(picture);
    return renderer.counts().casters - before.casters;
  };
  EXPECT_EQ(drawNext(), 36);
  EXPECT_EQ(drawNext(), 36);  // the layer, and the one over it
  EXPECT_EQ(drawNext(), 1);
  const DrawCounts before = renderer.counts();
  renderer.draw(picture);  // nothing moved
  EXPECT_EQ(renderer.counts().shadowMaps, before.shadowMaps);
  EXPECT_EQ(renderer.counts().shadowMasks, before.shadowMasks);
}

TEST(DrawCounts, ACameraThatComesNearerLeavesTheShadowsOfRoundBodiesAlone) {
  Renderer renderer({640, 360, Quality::kDraft, ""});
  Picture picture;
  picture.instances.resize(1);
  picture.instances[0].primitive = Primitive::kSphere;
  for (const float away : {60.0f, 20.0f, 4.0f}) {
    picture.camera.eye = picture.camera.target + Vec3f(0, 0, away);
    renderer.draw(picture);
  }
  EXPECT_EQ(renderer.counts().shadowMaps, 1);
}

TEST(DrawCounts, WhatNoPictureAskedForStaysAtZero) {
  Renderer renderer({64, 64, Quality::kDraft, ""});
  Picture picture = pyramidPicture(3);
  picture.light.shadows = false;
  renderer.draw(picture);
  const DrawCounts& counts = renderer.counts();
  EXPECT_EQ(counts.pictures, 1);
  EXPECT_EQ(counts.shadowMaps + counts.casters + counts.shadowMasks, 0);
  EXPECT_EQ(counts.strokes + counts.overlays, 0);
  picture.light.shadows = true;
  picture.caption = "a caption";
  picture.dots.resize(1);
  renderer.draw(picture);
  EXPECT_EQ(counts.shadowMaps, 1);
  EXPECT_EQ(counts.shadowMasks, 1);
  EXPECT_EQ(counts.strokes, 1);
  EXPECT_EQ(counts.overlays, 1);
}

}  // namespace
}  // namespace render
