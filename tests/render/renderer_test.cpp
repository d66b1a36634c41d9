// What is seen in the pictures that the renderer draws.
#include "render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/compare.h"
#include "render/geometry.h"
#include "seen.h"

namespace render {
namespace {

TEST(Renderer, ShowsTheBackgroundWhereNothingIs) {
  Picture picture = bare();
  picture.background = {0.2f, 0.4f, 0.6f, 1};
  const Rgb pixel = at(renderer().draw(picture), 10, 10);
  EXPECT_EQ(pixel.r, 51);
  EXPECT_EQ(pixel.g, 102);
  EXPECT_EQ(pixel.b, 153);
}

TEST(Renderer, ShowsABodyInItsColourAtItsPlace) {
  Picture picture = bare();
  picture.instances = {box({0.5f, 0.5f, 0.5f}, {1, 0.5f, 0}, kRed)};
  const Image& image = renderer().draw(picture);
  // Perspective: 120 px / (2 tan 20 deg * 5 m) = 33 px per metre, so the box is at (113, 43).
  const Rgb body = at(image, 113, 43);
  EXPECT_GT(body.r, 3 * body.g);
  EXPECT_EQ(at(image, 47, 43).sum(), 3 * 255);
  EXPECT_EQ(at(image, 113, 77).sum(), 3 * 255);
}

TEST(Renderer, DrawsACapsuleAsLongAsItsCapCentresAndTheCaps) {
  Picture picture = bare();
  Instance capsule = box({0.4f, 1, 0.4f}, {0, 0, 0}, kRed);
  capsule.primitive = Primitive::kCapsule;
  picture.instances = {capsule};
  const Image& image = renderer().draw(picture);
  EXPECT_LT(at(image, 80, 60 - 22).g, 200);  // 0.7 m = 23 px from the centre to the tip
  EXPECT_EQ(at(image, 80, 60 - 25).g, 255);
}

TEST(Renderer, NearBodiesHideFarOnesInAnyOrder) {
  Picture picture = bare();
  const Instance red = box({1, 1, 0.1f}, {0, 0, 1}, kRed);
  const Instance blue = box({1, 1, 0.1f}, {0, 0, -1}, {0.1f, 0.1f, 0.8f, 1});
  picture.instances = {red, blue};
  const Image first = renderer().draw(picture);
  picture.instances = {blue, red};
  EXPECT_EQ(first, renderer().draw(picture));
  EXPECT_GT(at(first, 80, 60).r, at(first, 80, 60).b);
}

TEST(Renderer, TranslucentBodiesLetThoseBehindShow) {
  Picture picture = bare();
  const Instance back = box({1, 1, 0.1f}, {0, 0, -1}, {0.1f, 0.1f, 0.8f, 1});
  Instance front = box({1, 1, 0.1f}, {0, 0, 1}, kRed);
  front.color.w() = 0.5f;
  picture.instances = {front, back};
  const Rgb pixel = at(renderer().draw(picture), 80, 60);
  EXPECT_GT(pixel.r, 60);
  EXPECT_GT(pixel.b, 60);
}

TEST(Renderer, TranslucentBodiesAreMixedFromTheFarthestToTheNearest) {
  Picture picture = bare();
  Instance blue = box({1, 1, 0.1f}, {0, 0, -1}, {0.1f, 0.1f, 0.8f, 0.6f});
  Instance red = box({1, 1, 0.1f}, {0, 0, 1}, kRed);
  red.color.w() = 0.6f;
  picture.instances = {red, blue};
  const Rgb pixel = at(renderer().draw(picture), 80, 60);
  EXPECT_GT(pixel.r, pixel.b);
}

TEST(Renderer, ShowsBodiesThatReachFarOutOfTheFocusAndBehindTheCamera) {
  Picture picture = bare();
  picture.focusRadius = 0.1f;
  picture.instances = {box({0.5f, 0.5f, 0.5f}, {0, 0, 3}, kRed)};
  EXPECT_LT(at(renderer().draw(picture), 80, 60).g, 100);
  picture.instances = {box({4, 0.1f, 40}, {0, -0.5f, 0}, kRed)};
  EXPECT_LT(at(renderer().draw(picture), 80, 100).g, 100);
}

TEST(Renderer, AMeshOfABoxLooksLikeTheBox) {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
  mesh->normals.assign(4, Vec3f::UnitZ());
  mesh->indices = {0, 1, 2, 0, 2, 3};
  Picture picture = bare();
  Instance sheet = box({2, 2, 2}, {0, 0, 0}, kRed);
  sheet.primitive = Primitive::kMesh;
  sheet.mesh = mesh;
  picture.instances = {sheet};
  const Rgb seen = at(renderer().draw(picture), 80, 60);
  picture.instances = {box({2, 2, 0.001f}, {0, 0, 0}, kRed)};
  const Rgb expected = at(renderer().draw(picture), 80, 60);
  EXPECT_NEAR(seen.r, expected.r, 1);
  EXPECT_NEAR(seen.g, expected.g, 1);
}

TEST(Renderer, LinesOnTopAreSeenThroughBodiesAndOthersAreNot) {
  Picture picture = bare();
  picture.instances = {box({1, 1, 1}, {0, 0, 0}, kRed)};
  const int covered = at(renderer().draw(picture), 80, 60).r;
  picture.lines = {{{-1, 0, -1}, {1, 0, -1}, {0, 0, 1, 1}, 24, false, false}};
  EXPECT_EQ(at(renderer().draw(picture), 80, 60).r, covered);
  picture.lines[0].onTop = true;
  EXPECT_EQ(at(renderer().draw(picture), 80, 60).b, 255);
  picture.lines = {{{-1, 0, 1}, {1, 0, 1}, {0, 0, 1, 1}, 24, false, false}};
  EXPECT_EQ(at(renderer().draw(picture), 80, 60).b, 255);  // it is in front
}

// A mesh of 256 pieces around, its axis y; `apart`: of the ends, in diameters.
std::shared_ptr<const Mesh> fineMesh(float apart) {
  auto mesh = std::make_shared<Mesh>();
  const Geometry geometry = apart > 0 ? unitCapsule(256) : unitSphere(256);
  for (const Vertex& vertex : geometry.vertices) {
    const auto& [x, y, z, end] = vertex.position;
    mesh->positions.push_back({x, y + 0.5f * apart * end, z});
    mesh->normals.push_back({vertex.normal[0], vertex.normal[1], vertex.normal[2]});
  }
  mesh->indices = geometry.indices;
  return mesh;
}

// How many pixels a round body and a fine mesh of it differ in, by more than one of four samples.
std::size_t differenceToMesh(Renderer& by, Picture picture, Instance body) {
  const float apart = body.primitive == Primitive::kCapsule ? body.size.y() / body.size.x() : 0;
  picture.instances = {body};
  const Image seen = by.draw(picture);
  if (apart > 0) body.size.setConstant(body.size.x());
  body.primitive = Primitive::kMesh;
  body.mesh = fineMesh(apart);
  picture.instances = {body};
  const Image wanted = by.draw(picture);
  return compareImages(seen, wanted, {90, 0, 120, 0, 0}).visible;
}

// Its outline is hundreds of pixels long; facets that were seen would differ in thousands.
TEST(Renderer, RoundBodiesLookLikeFineMeshesOfThemFromAllSides) {
  Renderer large({480, 360, Quality::kStandard, ""});
  Picture picture = bare();
  picture.ground.visible = true;
  picture.ground.height = -0.8f;
  Instance body = box({1, 1, 1}, {0.3f, 0.1f, 0}, kRed);
  body.marked = true;
  for (const float size : {0.15f, 0.7f, 1.4f}) {
    for (const float apart : {0.0f, 0.4f, 1.5f}) {
      for (const float tilt : {0.0f, 0.8f, 1.3f, 1.5707963f}) {
        body.primitive = apart > 0 ? Primitive::kCapsule : Primitive::kSphere;
        body.size = {size, apart > 0 ? apart : size, size};
        body.orientation =
            Eigen::AngleAxisf(0.4f, Vec3f::UnitZ()) * Eigen::AngleAxisf(tilt, Vec3f::UnitX());
        EXPECT_LT(differenceToMesh(large, picture, body), 60u)  // measured 53
            << size << " " << apart << " " << tilt;
      }
    }
  }
  body.primitive = Primitive::kSphere;
  body.size = {0.5f, 1.4f, 0.9f};
  EXPECT_LT(differenceToMesh(large, picture, body), 60u) << "an ellipsoid";
}

TEST(Renderer, OnlyAMarkedBallShowsItsTurning) {
  Picture picture = bare();
  Instance ball = box({1, 1, 1}, {0, 0, 0}, kRed);
  ball.primitive = Primitive::kSphere;
  const auto changed = [&](bool marked) {
    ball.marked = marked;
    ball.orientation = Eigen::Quaternionf::Identity();
    picture.instances = {ball};
    const Image before = renderer().draw(picture);
    ball.orientation = Eigen::Quaternionf(Eigen::AngleAxisf(0.6f, Vec3f(1, 2, 0).normalized()));
    picture.instances = {ball};
    return compareImages(before, renderer().draw(picture), {8, 0, 32, 0, 0}).visible;
  };
  EXPECT_GT(changed(true), 100u);
  EXPECT_EQ(changed(false), 0u);
}

TEST(Renderer, LooksStraightDownAndAlongADegenerateUp) {
  Picture picture = bare();
  picture.camera = {{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 40};
  picture.instances = {box({1, 1, 1}, {0, 0, 0}, kRed)};
  EXPECT_GT(at(renderer().draw(picture), 80, 60).r, 100);
}

TEST(Renderer, RefusesNumbersThatAreNotFiniteAndMissingMeshes) {
  Picture picture = bare();
  picture.instances = {box({1, 1, 1}, {0, std::nanf(""), 0}, kRed)};
  EXPECT_THROW(renderer().draw(picture), std::invalid_argument);
  picture.instances = {box({1, 1, 1}, {0, 0, 0}, kRed)};
  picture.instances[0].primitive = Primitive::kMesh;
  EXPECT_THROW(renderer().draw(picture), std::invalid_argument);
  picture = bare();
  picture.camera.target = picture.camera.eye;
  EXPECT_THROW(renderer().draw(picture), std::invalid_argument);
  EXPECT_THROW(Renderer({0, 10, Quality::kDraft, ""}), std::invalid_argument);
  EXPECT_THROW(Renderer({64, 64, Quality::kDraft, "/no/such/font.ttf"}), std::runtime_error);
}

}  // namespace
}  // namespace render
