// [film] [light] [[label]], the background, and cameras that fit several bodies or follow one.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/view/view.h"
#include "tests/scenes/picture_of.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

using physics::Vec3;

Scene filmed(const std::string& film, int fps = 60) {
  return sceneOf("duration = 1\n" + ball("a") + "[simulation]\nfps = " + std::to_string(fps) +
                 "\n[film]\n" + film);
}

TEST(Film, SlowMotionIsSteppedFiner) {
  const Scene scene = filmed("speed = 0.25\n");
  EXPECT_EQ(scene.fps, 240);
  EXPECT_EQ(scene.film.every, 1);
  EXPECT_DOUBLE_EQ(scene.settings.dt, 1.0 / 240);
  EXPECT_EQ(scene.frameCount(), 241);
}

TEST(Film, OfFewerFramesTakesStepsNoLongerThanTheSimulations) {
  const Scene scene = filmed("fps = 25\n");
  EXPECT_EQ(scene.film.every, 3);
  EXPECT_EQ(scene.fps, 75);
  EXPECT_EQ(filmed("fps = 30\n").film.every, 2);
}

TEST(Film, TheShutterSeesEightMomentsOfTheFrame) {
  const Scene half = filmed("shutter = 180\n"), whole = filmed("shutter = 360\n");
  EXPECT_EQ(half.film.every, 16);
  EXPECT_EQ(half.film.moments, 8);
  EXPECT_EQ(half.fps, 960);
  EXPECT_EQ(whole.film.every, 8);
  EXPECT_EQ(whole.film.moments, 8);
}

TEST(Film, RefusesFramesBetweenTheSteps) {
  const std::string text = ball("a") + "[film]\nspeed = 0.7\n";
  EXPECT_EQ(errorOf(text),
            "test.toml:5:9: film.speed: expected fps / speed to be a whole number from 1 to "
            "1000000, got 60 / 0.7 = 85.7143");
  EXPECT_NE(errorOf(ball("a") + "[film]\nspeed = 0.001\nshutter = 1\n").find("steps a second"),
            std::string::npos);
}

TEST(Light, HasADirectionAColourAndASoftness) {
  const render::Picture picture =
      pictureOf(ball("a") + "[light]\ndirection = [1, -1, 0]\ncolor = [1, 0, 0]\nsoftness = 10\n");
  EXPECT_GT(picture.light.direction.x(), 0);
  EXPECT_EQ(picture.light.color, render::Vec3f(1, 0, 0));
  EXPECT_NEAR(picture.light.softness, std::tan(M_PI / 18), 1e-6);
  EXPECT_NE(errorOf(ball("a") + "[light]\ndirection = [1, 1, 0]\n").find("from above"),
            std::string::npos);
}

TEST(Background, IsAColourOrNothing) {
  EXPECT_EQ(pictureOf("background = \"black\"\n" + ball("a")).background,
            render::Color(0, 0, 0, 1));
  EXPECT_EQ(pictureOf("background = \"transparent\"\n" + ball("a")).background.w(), 0);
  EXPECT_NE(errorOf("background = \"transparant\"\n" + ball("a")).find("'transparent'?"),
            std::string::npos);
}

TEST(Label, StaysBesideItsBodyForItsTime) {
  const std::string label = ball("a") + "position = [1, 2, 3]\n[[label]]\ntext = \"here\"\n";
  const render::Picture picture = pictureOf(label + "body = \"a\"\nat = [0, 1, 0]\n");
  ASSERT_EQ(picture.labels.size(), 1u);
  EXPECT_EQ(picture.labels[0].at, render::Vec3f(1, 3, 3));
  EXPECT_TRUE(pictureOf(label + "at = [0, 1, 0]\nfrom = 1\n").labels.empty());
  EXPECT_NE(errorOf(label + "body = \"b\"\n").find("label.body: no body 'b'"), std::string::npos);
  EXPECT_NE(errorOf(label).find("expected 'body', 'at' or both"), std::string::npos);
}

std::string at(const std::string& name, double x) {
  return ball(name) + "position = [" + std::to_string(x) + ", 0, 0]\n";
}

TEST(Camera, FitsSeveralBodies) {
  const std::string all = at("a", -10) + at("b", 0) + at("c", 30);
  const auto radius = [&](const std::string& camera) {
    return pictureOf(all + camera).focusRadius;
  };
  EXPECT_NEAR(radius("[camera]\nfit = \"b\"\n"), std::sqrt(3), 1e-5);
  EXPECT_NEAR(radius("[camera]\nfit = [\"a\", \"b\"]\n"), std::sqrt(36 + 1 + 1), 1e-5);
  EXPECT_NE(errorOf(all + "[camera]\nfit = [\"a\", \"d\"]\n").find("camera.fit: no body 'd'"),
            std::string::npos);
}

TEST(Camera, FollowsABody) {
  Simulation simulation(
      sceneOf(at("a", 5) + "velocity = [60, 0, 0]\n[camera]\nfollow = \"a\"\nmargin = 1\n"));
  MotionBounds bounds;
  bounds.include(simulation);
  const render::Picture first = view(simulation, bounds, {}, {});
  simulation.advance();
  bounds.include(simulation);
  const render::Picture second = view(simulation, bounds, {}, {});
  EXPECT_NEAR((second.camera.eye - first.camera.eye).x(), 1, 1e-4);
  EXPECT_NEAR((second.camera.target - first.camera.target).x(), 1, 1e-4);
  EXPECT_NEAR(bounds.high.x(), 1, 1e-9);  // of the ball about its middle
}

// A mast of 10 m, 0.1 m thick, and not the ball of 10 m around it.
TEST(Camera, FitsAndFollowsByASecondName) {
  const std::string doll = "[[ragdoll]]\nname = \"d\"\n[camera]\n";
  MotionBounds head;
  head.include(Simulation(sceneOf(doll + "fit = \"d.head\"\n")));
  EXPECT_LT((head.high - head.low).norm(), 0.5);
  EXPECT_GT(head.low.y(), 1.4);
  MotionBounds around;
  around.include(Simulation(sceneOf(doll + "follow = \"d.head\"\n")));
  EXPECT_LT(around.high.y(), 0.2);
}

TEST(Camera, FitsShapesAsTheyAreTurned) {
  const auto boundsOf = [](const std::string& body) {
    const Simulation simulation(sceneOf("[[body]]\nname = \"mast\"\n" + body));
    MotionBounds bounds;
    bounds.include(simulation);
    return Vec3(bounds.high - bounds.low);
  };
  EXPECT_TRUE(
      boundsOf("shape = { box = { size = [0.1, 10, 0.1] } }\n").isApprox(Vec3(0.1, 10, 0.1)));
  EXPECT_TRUE(boundsOf("shape = { cylinder = { radius = 0.05, length = 10 } }\n"
                       "rotation = { axis = [0, 0, 1], degrees = 90 }\n")
                  .isApprox(Vec3(10, 0.1, 0.1)));
  EXPECT_TRUE(boundsOf("shape = { capsule = { radius = 0.05, length = 10 } }\n")
                  .isApprox(Vec3(0.1, 10.1, 0.1)));
}

TEST(View, APendulumIsSeenWithItsRodAndWhatItHangsFrom) {
  const render::Picture picture =
      pictureOf(ball("a") + "[[ball_socket]]\nbodies = [\"world\", \"a\"]\nat = [0, 4, 0]\n");
  ASSERT_EQ(picture.instances.size(), 3u);
  EXPECT_NEAR(picture.instances[1].size.y(), 4, 1e-6);
  EXPECT_EQ(picture.instances[2].position, render::Vec3f(0, 4, 0));
  EXPECT_NEAR(picture.focusCenter.y(), 1.5, 1e-6);  // from -1 to 4
  const render::Picture near =
      pictureOf(ball("a") + "[[ball_socket]]\nbodies = [\"world\", \"a\"]\nat = [0, 1, 0]\n");
  EXPECT_EQ(near.instances.size(), 1u);
}

TEST(View, VectorsShowTheConeOfALimit) {
  ViewOptions options;
  options.overlays.vectors = true;
  const render::Picture picture =
      pictureOf(ball("a") + ball("b") +
                    "[[cone_limit]]\nbodies = [\"a\", \"b\"]\naxis = [0, 1, 0]\ndegrees = 30\n",
                options);
  ASSERT_EQ(picture.surfaces.size(), 1u);
  const render::Surface& cone = picture.surfaces[0];
  const render::Vec3f apex = cone.positions[0];
  for (std::size_t i = 0; i < cone.positions.size(); ++i) {
    if (i % 3 == 0) continue;
    const render::Vec3f along = cone.positions[i] - apex;
    EXPECT_NEAR(along.y() / along.norm(), std::sqrt(0.75), 1e-5);
  }
}

TEST(View, WhatNeverTurnsHasNoMarks) {
  EXPECT_FALSE(pictureOf(ball("a") + "fixed = true\n").instances[0].marked);
}

}  // namespace
}  // namespace scenes
