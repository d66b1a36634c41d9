// The same picture is the same bytes: again, after others, in other Renderers, threads and
// processes.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "folder.h"
#include "render/child.h"
#include "render/png.h"
#include "render/renderer.h"
#include "sample.h"

namespace render {
namespace {

const RendererOptions kOptions{320, 180, Quality::kStandard, ""};

Picture fullPicture() {
  Picture picture = samplePicture();
  picture.hud = sampleHud(90);
  return picture;
}

class Repeatable : public ::testing::TestWithParam<Quality> {};

TEST_P(Repeatable, DrawingAgainAndAfterOtherPicturesChangesNothing) {
  RendererOptions options = kOptions;
  options.quality = GetParam();
  Renderer renderer(options);
  const Image first = renderer.draw(fullPicture());
  EXPECT_EQ(first, renderer.draw(fullPicture()));
  Picture other = ragdollPicture(20);
  other.ground.visible = false;
  other.light.shadows = false;
  other.labels.push_back({{0, 0, 0}, "another size", {0, 0}, {1, 0, 0, 1}, 31});
  renderer.draw(other);
  Picture empty;
  renderer.draw(empty);
  EXPECT_EQ(first, renderer.draw(fullPicture()));
}

INSTANTIATE_TEST_SUITE_P(Qualities, Repeatable,
                         ::testing::Values(Quality::kDraft, Quality::kStandard, Quality::kPaper));

TEST(RepeatableOver, RenderersInOneThread) {
  Renderer first(kOptions), second(kOptions);
  const Image expected = first.draw(fullPicture());
  second.draw(pyramidPicture(5));
  EXPECT_EQ(expected, second.draw(fullPicture()));
  EXPECT_EQ(expected, first.draw(fullPicture()));
}

TEST(RepeatableOver, RenderersInManyThreads) {
  const Image expected = Renderer(kOptions).draw(fullPicture());
  std::vector<int> same(3);
  std::vector<std::thread> threads;
  for (int& result : same)
    threads.emplace_back([&result, &expected] {
      Renderer renderer(kOptions);
      for (int i = 0; i < 3; ++i) result += renderer.draw(fullPicture()) == expected ? 1 : 0;
    });
  for (std::thread& thread : threads) thread.join();
  for (const int count : same) EXPECT_EQ(count, 3);
}

TEST(RepeatableOver, AMeshThatTookTheAddressOfAnother) {
  const auto pictureOf = [](float side) {
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {{0, 0, 0}, {side, 0, 0}, {0, side, 0}};
    mesh->normals.assign(3, Vec3f::UnitZ());
    mesh->indices = {0, 1, 2};
    Picture picture;
    picture.instances.resize(1);
    picture.instances[0].primitive = Primitive::kMesh;
    picture.instances[0].mesh = mesh;
    return picture;
  };
  const Image expected = Renderer(kOptions).draw(pictureOf(2));
  Renderer renderer(kOptions);
  for (int i = 0; i < 4; ++i) renderer.draw(pictureOf(0.5f + static_cast<float>(i)));
  EXPECT_EQ(expected, renderer.draw(pictureOf(2)));
}

using RepeatableOverProcesses = TestFolder;

TEST_F(RepeatableOverProcesses, WithAnyNumberOfThreads) {
  for (const std::string name : {"hud", "cloth"}) {
    const Image here = Renderer(kOptions).draw(name == "hud" ? fullPicture() : clothPicture(60));
    for (const char* threads : {"LP_NUM_THREADS=0", "LP_NUM_THREADS=1", "LP_NUM_THREADS=3"}) {
      const std::string file = (folder / (name + threads + ".png")).string();
      const ChildResult result =
          runChild({"env", threads, DRAW_SAMPLE, name, "standard", file, "320", "180"});
      ASSERT_EQ(result.exitCode, 0) << result.errors;
      EXPECT_EQ(readPng(file), here) << name << " with " << threads;
    }
  }
}

}  // namespace
}  // namespace render
