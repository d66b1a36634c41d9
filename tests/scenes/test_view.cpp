// Pictures show every body, from where all of the motion is seen.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/view/camera.h"
#include "scenes/view/overlays.h"
#include "scenes/view/palette.h"
#include "scenes/view/view.h"
#include "tests/scenes/picture_of.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

using physics::Vec3;

// The point's place in the picture, -1..1 in both directions.
Eigen::Vector2d project(const render::Camera& camera, const Vec3& point, double aspect) {
  const Vec3 forward = (camera.target - camera.eye).cast<double>().normalized();
  const Vec3 right = forward.cross(Vec3::UnitY()).normalized();
  const Vec3 up = right.cross(forward);
  const Vec3 d = point - camera.eye.cast<double>();
  const double slope = std::tan(camera.fieldOfViewDegrees * M_PI / 360) * d.dot(forward);
  return {d.dot(right) / (slope * aspect), d.dot(up) / slope};
}

TEST(Camera, SeesTheWholeBoxAndFillsOneDirection) {
  const MotionBounds box{Vec3(-3, 0, -1), Vec3(5, 2, 1)};
  const render::Camera camera = fitCamera({}, box, 16.0 / 9, 0);
  double most = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1 ? 5 : -3, i & 2 ? 2 : 0, i & 4 ? 1 : -1);
    most = std::max(most, project(camera, corner, 16.0 / 9).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(most, 1.0);
  EXPECT_GT(most, 0.8);
}

TEST(Camera, StaysAboveTheGround) {
  CameraDef def;
  def.direction = Vec3(0, 0.3, -1);  // from below
  EXPECT_GT(fitCamera(def, {Vec3(-1, 0, -1), Vec3(1, 2, 1)}, 1.5, 0).eye.y(), 0);
}

TEST(Camera, PassesThroughItsKeys) {
  std::vector<CameraKey> keys(3);
  for (int i = 0; i < 3; ++i) keys[i].time = i, keys[i].eye = Vec3(i * i, 1, 5);
  EXPECT_NEAR(keyCamera(keys, 1).eye.x(), 1, 1e-6);
  EXPECT_NEAR(keyCamera(keys, 9).eye.x(), 4, 1e-6);
}

TEST(View, LooksAtAPointThatRestsFromAside) {
  const render::Picture picture =
      pictureOf("[[body]]\nname = \"a\"\nshape = { point = {} }\nmass = 1\n");
  EXPECT_GT((picture.camera.eye - picture.camera.target).norm(), 0.1f);
  EXPECT_GT(picture.focusRadius, 0.1f);
}

TEST(View, DrawsALevelPlaneAsTheGround) {
  const render::Picture picture =
      pictureOf("[[body]]\nshape = { plane = { offset = 0.5 } }\n" + ball("a"));
  EXPECT_FLOAT_EQ(picture.ground.height, 0.5f);
  EXPECT_EQ(picture.instances.size(), 1u);
}

TEST(View, DrawsATiltedPlaneAsAPlate) {
  const render::Picture picture =
      pictureOf("[[body]]\nshape = { plane = { normal = [1, 1, 0] } }\n" + ball("a"));
  EXPECT_EQ(picture.instances.size(), 2u);
}

TEST(View, DrawsDiametersOfShapes) {
  const render::Picture picture = pictureOf(ball("a"));
  EXPECT_EQ(picture.instances[0].primitive, render::Primitive::kSphere);
  EXPECT_EQ(picture.instances[0].size, render::Vec3f(2, 2, 2));
  EXPECT_TRUE(picture.instances[0].marked);
}

TEST(View, TakesTheColourOfTheScene) {
  const render::Picture picture = pictureOf(ball("a") + "color = \"#ff0080\"\n");
  EXPECT_TRUE(picture.instances[0].color.isApprox(render::Color(1, 0, 128.0f / 255, 1)));
  for (const char* glass : {"\"#ff008033\"", "[1, 0, 0.50196078, 0.2]"}) {
    const render::Picture seen = pictureOf(ball("a") + "color = " + glass + "\n");
    EXPECT_TRUE(seen.instances[0].color.isApprox(render::Color(1, 0, 128.0f / 255, 0.2f))) << glass;
  }
}

TEST(View, AlternatesTheTonesOfAChain) {
  const render::Picture picture = pictureOf("[[chain]]\nfrom = [0, 0, 0]\nlength = 1\ncount = 3\n");
  EXPECT_NE(picture.instances[0].color, picture.instances[1].color);
  EXPECT_EQ(picture.instances[0].color, picture.instances[2].color);
}

TEST(View, ShowsCentresOfMassOnRequest) {
  ViewOptions options;
  EXPECT_TRUE(pictureOf(ball("a"), options).dots.empty());
  options.overlays.centresOfMass = true;
  EXPECT_EQ(pictureOf(ball("a"), options).dots.size(), 1u);
}

TEST(View, NamesTheVectorsOfAnArmOnRequest) {
  const std::string arm = "[[arm]]\nat = [0, 0, 0]\ncount = 2\nlength = 1\ntarget = [1, 1, 0]\n";
  ViewOptions options;
  EXPECT_TRUE(pictureOf(arm, options).labels.empty());
  const auto textsOf = [&](bool Overlays::*shown) {
    options.overlays = {};
    options.overlays.*shown = true;
    std::vector<std::string> texts;
    for (const render::Label& label : pictureOf(arm, options).labels) texts.push_back(label.text);
    return texts;
  };
  EXPECT_EQ(textsOf(&Overlays::arms),
            (std::vector<std::string>{"*d*_{11}", "*d*_{12}", "*s*_{1}", "*s*_{2}", "*θ*_{1}",
                                      "*θ*_{2}", "δ*x*", "target"}));
  EXPECT_EQ(textsOf(&Overlays::armAngles), (std::vector<std::string>{"*θ*_{1}", "*θ*_{2}"}));
}

TEST(View, ShowsTheTitleInTheHud) {
  ViewOptions options;
  options.hud = true;
  EXPECT_EQ(pictureOf("title = \"A ball\"\n" + ball("a"), options).hud.title, "A ball");
}

std::string rowOf(const render::Hud& hud, const std::string& name) {
  for (const auto& [key, value] : hud.rows)
    if (key == name) return value;
  return "(absent)";
}

TEST(View, TellsTheStepAndItsSubsteps) {
  const auto substepsOf = [](const std::string& settings) {
    const Simulation run(sceneOf("[simulation]\nfps = 60\n" + settings + ball("a")));
    return rowOf(makeHud(run, {}), "substeps");
  };
  EXPECT_EQ(substepsOf(""), "as each island asks");
  EXPECT_EQ(substepsOf("substeps = 7\n"), "7");
}

TEST(Palette, GivesNeighbouringHuesThatDifferInLightnessOrHue) {
  for (int hue = 0; hue < 7; ++hue) {
    const auto a = familyColor(Pattern::kSingle, hue, 0);
    const auto b = familyColor(Pattern::kSingle, hue + 1, 0);
    EXPECT_GT((a - b).norm(), 0.25f);
  }
}

}  // namespace
}  // namespace scenes
