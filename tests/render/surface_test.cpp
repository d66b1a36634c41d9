// Sheets of triangles: two sides, smooth normals, lines, shadows, and what is refused.
#include <gtest/gtest.h>

#include <limits>

#include "render/compare.h"
#include "render/geometry.h"
#include "render/picture_hash.h"
#include "sample.h"
#include "seen.h"

namespace render {
namespace {

const Color kGreen(0.1f, 0.7f, 0.1f, 1);

// A square of side 2 in the plane z = 0, its front towards +z.
Surface sheet(const Color& front, const Color& back) {
  Surface surface;
  surface.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  surface.indices = {0, 1, 2, 0, 2, 3};
  surface.color = front;
  surface.backColor = back;
  return surface;
}

Picture sheetPicture(const Color& front = kRed, const Color& back = kGreen) {
  Picture picture = bare();
  picture.surfaces = {sheet(front, back)};
  return picture;
}

TEST(Surface, ShowsItsColourInFrontAndItsBackColourFromBehind) {
  Picture picture = sheetPicture();
  const Rgb front = at(renderer().draw(picture), 80, 60);
  EXPECT_GT(front.r, 3 * front.g);
  picture.camera.eye = {0, 0, -5};
  const Rgb back = at(renderer().draw(picture), 80, 60);
  EXPECT_GT(back.g, 2 * back.r);
}

TEST(Surface, IsBrightOnTheSideThatTheLightFallsOn) {
  Picture picture = sheetPicture(kRed, kRed);
  const auto brightness = [&](float eye, float light) {
    picture.camera.eye = {0, 0, eye};
    picture.light.direction = {0, 0, light};
    return at(renderer().draw(picture), 80, 60).sum();
  };
  EXPECT_GT(brightness(5, -1), brightness(5, 1) + 60);
  EXPECT_GT(brightness(-5, 1), brightness(-5, -1) + 60);
  EXPECT_NEAR(brightness(5, -1), brightness(-5, 1), 3);  // the same from both sides
}

TEST(Surface, LooksLikeABoxOfItsPlace) {
  Picture picture = sheetPicture(kRed, kRed);
  const Rgb seen = at(renderer().draw(picture), 80, 60);
  picture.surfaces.clear();
  picture.instances = {box({2, 2, 0.001f}, {0, 0, 0}, kRed)};
  const Rgb expected = at(renderer().draw(picture), 80, 60);
  EXPECT_NEAR(seen.r, expected.r, 2);
  EXPECT_NEAR(seen.g, expected.g, 2);
}

TEST(Surface, ThrowsNoShadowOnItself) {
  Picture picture = sheetPicture();
  for (const Vec3f& light : {Vec3f(0, 0, -1), Vec3f(1, -1, -1), Vec3f(0, -3, -1)}) {
    picture.light.direction = light;
    picture.light.shadows = true;
    const Image with = renderer().draw(picture);
    picture.light.shadows = false;
    EXPECT_LE(compareImages(with, renderer().draw(picture), {8, 0, 32, 0, 0}).visible, 0u);
  }
}

TEST(Surface, CastsAShadowOnTheGroundAndOnBodies) {
  Picture picture = bare();
  picture.ground.visible = true;
  picture.ground.spacing = 100;
  picture.camera.eye = {3, 6, 0.1f};
  picture.light.direction = {0, -1, 0};
  const Rgb empty = at(renderer().draw(picture), 80, 60);
  Surface roof = sheet(kRed, kRed);
  for (Vec3f& p : roof.positions) p = {p.x(), 3, p.y()};
  picture.surfaces = {roof};
  EXPECT_LT(at(renderer().draw(picture), 80, 60).sum(), empty.sum() - 60);
  picture.instances = {box({1, 0.1f, 1}, {0, 0.05f, 0}, kRed)};
  const int shaded = at(renderer().draw(picture), 80, 60).sum();
  picture.surfaces.clear();
  EXPECT_LT(shaded, at(renderer().draw(picture), 80, 60).sum() - 60);
}

TEST(Surface, LinesOfTheGridAreDarkerThanItsCells) {
  Picture picture = sheetPicture();
  const int plain = at(renderer().draw(picture), 80, 50).sum();
  picture.surfaces[0].grid = {{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}};
  const Image& image = renderer().draw(picture);  // lines through the middle, x = 80 and y = 60
  EXPECT_LT(std::min(at(image, 80, 50).sum(), at(image, 79, 50).sum()), plain - 8);
  EXPECT_NEAR(at(image, 95, 50).sum(), plain, 6);
}

TEST(Surface, EdgesOfTrianglesAreDarkerThanTheirMiddles) {
  Picture picture = sheetPicture();
  picture.surfaces[0].edges = true;  // one edge is the diagonal, through the middle
  const Image& image = renderer().draw(picture);
  EXPECT_LT(at(image, 80, 59).sum(), at(image, 95, 60).sum() - 10);
}

TEST(Surface, IsDrawnOffsetAlongItsNormals) {
  Picture picture = sheetPicture();
  picture.surfaces[0].offset = 1;
  picture.instances = {box({1, 1, 0.1f}, {0, 0, 0.5f}, kGreen)};
  const Rgb seen = at(renderer().draw(picture), 80, 60);
  EXPECT_GT(seen.r, seen.g);
}

TEST(Surface, LetsThoseBehindShowWhereItIsTranslucent) {
  Picture picture = sheetPicture({0.8f, 0.1f, 0.1f, 0.5f}, {0.8f, 0.1f, 0.1f, 0.5f});
  picture.instances = {box({1, 1, 0.1f}, {0, 0, -1}, {0.1f, 0.1f, 0.8f, 1})};
  const Rgb pixel = at(renderer().draw(picture), 80, 60);
  EXPECT_GT(pixel.r, 60);
  EXPECT_GT(pixel.b, 60);
}

TEST(Surface, ThatIsEmptyOrFoldedToNothingIsDrawnWithoutHarm) {
  Picture picture = bare();
  picture.surfaces.resize(2);
  picture.surfaces[1].positions.assign(3, Vec3f::Zero());
  picture.surfaces[1].indices = {0, 1, 2};
  EXPECT_EQ(at(renderer().draw(picture), 80, 60).sum(), 3 * 255);
}

TEST(Surface, ChangesTheHashWithEveryVertex) {
  const Picture picture = sheetPicture();
  for (std::size_t i = 0; i < 4; ++i) {
    Picture moved = picture;
    moved.surfaces[0].positions[i].z() += 1e-6f;
    EXPECT_NE(pictureHash(moved), pictureHash(picture));
  }
}

TEST(Surface, IsRefusedWhereItsListsDoNotFit) {
  const auto refused = [](const std::function<void(Surface&)>& spoil) {
    Picture picture = sheetPicture();
    spoil(picture.surfaces[0]);
    EXPECT_THROW(renderer().draw(picture), std::invalid_argument);
  };
  refused([](Surface& s) { s.indices.pop_back(); });
  refused([](Surface& s) { s.indices[0] = 4; });
  refused([](Surface& s) { s.grid.resize(3); });
  refused([](Surface& s) { s.positions[1].x() = std::numeric_limits<float>::quiet_NaN(); });
  refused([](Surface& s) { s.offset = std::numeric_limits<float>::infinity(); });
}

TEST(SmoothNormals, AreTheMeanOfTheFacesByArea) {
  // A roof: two squares of area 1 at a right angle share an edge.
  const std::vector<Vec3f> p = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, {0, -1, 1}, {0, -1, 0}};
  const std::vector<Vec3f> normals = smoothNormals(p, {0, 1, 2, 0, 2, 3, 0, 5, 4, 0, 4, 1});
  EXPECT_TRUE(normals[3].isApprox(Vec3f::UnitY()));
  EXPECT_TRUE(normals[5].isApprox(-Vec3f::UnitX()));
  EXPECT_TRUE(normals[0].isApprox(Vec3f(-1, 1, 0).normalized()));
  EXPECT_TRUE(normals[1].y() > 0 && normals[1].x() < 0);
}

TEST(CreasedNormals, StaySharpAtARightAngleAndAreSmoothAcrossSmallOnes) {
  const std::vector<Vec3f> roof = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0, -1, 1}};
  const std::vector<Vec3f> sharp = creasedNormals(roof, {0, 1, 2, 0, 3, 1});
  EXPECT_TRUE(sharp[0].isApprox(Vec3f::UnitY()));
  EXPECT_TRUE(sharp[3].isApprox(-Vec3f::UnitX()));
  const std::vector<Vec3f> flat = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {-1, -0.2f, 1}};
  const std::vector<Vec3f> smooth = creasedNormals(flat, {0, 1, 2, 0, 3, 1});
  EXPECT_TRUE(smooth[0].isApprox(smooth[3]));
  EXPECT_LT(smooth[0].x(), 0);
  EXPECT_TRUE(smooth[2].isApprox(Vec3f::UnitY()));
}

}  // namespace
}  // namespace render
