// MJCF: height fields, keyframes, tendons.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/bodies/triangles.h"
#include "tests/scenes/model_text.h"

namespace scenes {
namespace {

using physics::Vec3;

bool tells(const Scene& scene, const std::string& what) {
  return std::any_of(scene.told.begin(), scene.told.end(),
                     [&](const std::string& line) { return line.find(what) != std::string::npos; });
}

// Two by three heights: the row of the greatest y is high at its middle.
const std::string kHills =
    "<asset><hfield name='h' nrow='2' ncol='3' size='3 2 .5 .1' elevation='1 1 1 1 5 1'/></asset>";

TEST(MjcfHeights, AreGroundAsHighAsTheirSizeSays) {
  const Scene scene =
      modelOf(mujoco(kHills + "<worldbody><geom type='hfield' hfield='h' pos='0 0 1'/>"
                              "<body name='a' pos='0 -1.9 2'><freejoint/><geom size='.1'/></body>"
                              "</worldbody>"));
  EXPECT_TRUE(scene.told.empty());
  Simulation s(scene);
  const physics::Bodies& b = s.world().bodies();
  Vec3 highest = Vec3::Zero();
  for (const Vec3& vertex : std::get<physics::Triangles>(b.shape[1]).mesh->vertices) {
    const Vec3 at = b.pose[1].x + b.pose[1].q * vertex;
    if (at.y() > highest.y()) highest = at;
  }
  EXPECT_LT((highest - yUp(0, 2, 1.5)).norm(), 1e-12);
  for (int frame = 0; frame < 40; ++frame) s.advance();
  EXPECT_NEAR(poseOf(s, "a").x.y(), 1.1, 0.02);  // it lies where the field is low
}

TEST(MjcfHeights, AreRefusedOrLeftOutWithTheirReason) {
  const auto field = [](const std::string& attributes) {
    return modelError(mujoco("<asset><hfield name='h' " + attributes + "/></asset>"));
  };
  EXPECT_EQ(field("nrow='2' ncol='2' size='1 1 0 1'"),
            "m.xml:2:9: <hfield>: size: expected four numbers > 0");
  EXPECT_EQ(field("nrow='2' ncol='2' size='1 1 1 1' elevation='1 2'"),
            "m.xml:2:9: <hfield>: elevation: expected 4 numbers, got 2");
  EXPECT_EQ(field("size='1 1 1 1'"),
            "m.xml:2:9: <hfield>: nrow, ncol: expected 2 to 401, or a file");
  EXPECT_EQ(field("file='none.png' size='1 1 1 1'"), "m.xml:2:9: <hfield>: no file 'none.png'");
  EXPECT_TRUE(tells(modelOf(mujoco(kHills + "<worldbody><body><freejoint/><geom size='.1'/>"
                                            "<geom type='hfield' hfield='h'/></body></worldbody>")),
                    "not read: <geom> of an <hfield> on a body that moves"));
}

// A cart on a slide and a tilted hinge, with a pendulum below: two joints of one body.
std::string keyed(const std::string& keys) {
  return mujoco(
      "<worldbody><body name='free'><freejoint/><geom size='.1'/></body>"
      "<body name='arm' pos='0 0 2'><joint name='x' type='slide' axis='1 0 0'/>"
      "<joint name='y' axis='0 1 0' range='-90 90'/><geom size='.1' pos='0 0 -1'/>"
      "<body name='tip' pos='0 0 -1'><joint name='z' type='ball'/><geom size='.1' pos='1 0 0'/>"
      "</body></body></worldbody>"
      "<actuator><motor joint='y' name='m' gear='3'/><position joint='x' kp='10'/></actuator>"
      "<keyframe>" +
      keys + "</keyframe>");
}

Scene startingIn(const std::string& text, const std::string& key) {
  const std::vector<std::string> settings{"keyframe=" + key};
  return parseScene(text, "m.xml", settings);
}

// Slid by 0.5 along x, then turned by 90 degrees about y: what hung down points to -x.
TEST(MjcfKeyframe, IsThePoseToStartIn) {
  const std::string model = keyed(
      "<key name='there' qpos='1 2 3 0.7071067811865476 0 0 0.7071067811865476 "
      "0.5 1.5707963267948966 0.7071067811865476 0 0 0.7071067811865476' ctrl='2 0.7'/>");
  EXPECT_TRUE(tells(modelOf(model), "--set keyframe=there"));
  const Simulation s(startingIn(model, "there"));
  EXPECT_LT((poseOf(s, "free").x - yUp(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((poseOf(s, "free").q * Vec3::UnitX() - yUp(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((poseOf(s, "arm").x - yUp(-0.5, 0, 2)).norm(), 1e-12);
  // The tip hangs on at -0.5 as well; its own ball turns its x, by then to -z, to y.
  EXPECT_LT((poseOf(s, "tip").x - yUp(-0.5, 1, 2)).norm(), 1e-12);
  for (const physics::KindError& error : s.world().constraintErrors()) {
    EXPECT_LT(error.largest, 1e-9) << error.kind;
  }
}

TEST(MjcfKeyframe, LimitsCountFromWhereTheJointWas) {
  Simulation s(startingIn(keyed("<key name='k' qpos='0 0 9 1 0 0 0 0 1.5 1 0 0 0'/>"), "k"));
  for (int frame = 0; frame < 10; ++frame) s.advance();
  for (const physics::KindError& error : s.world().constraintErrors()) {
    EXPECT_LT(error.largest, 1e-3) << error.kind;  // a limit of 90 from here would be far off
  }
}

TEST(MjcfKeyframe, IsRefusedWithItsReason) {
  const auto wrong = [](const std::string& keys, const std::string& key) -> std::string {
    try {
      startingIn(keyed(keys), key);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(wrong("<key name='home'/>", "hom"),
            "--set keyframe=hom: no <key> 'hom'; did you mean 'home'?");
  EXPECT_NE(wrong("<key name='a' qpos='1 2'/>", "a").find("expected more than 2 numbers"),
            std::string::npos);
  EXPECT_EQ(wrong("<key/>", "0"), "no error");
}

std::string strung(const std::string& attributes, const std::string& sites) {
  return mujoco(
      "<worldbody><site name='up' pos='0 0 3'/>"
      "<body name='a' pos='0 0 2'><freejoint/><geom size='.1' mass='2'/>"
      "<site name='eye' pos='0 0 .1'/></body></worldbody>"
      "<tendon><spatial " +
      attributes + ">" + sites + "</spatial></tendon>");
}
const std::string kStraight = "<site site='up'/><site site='eye'/>";

TEST(MjcfTendon, OfALimitIsARope) {
  Simulation s(modelOf(strung("range='0 1.5'", kStraight)));
  for (int frame = 0; frame < 240; ++frame) s.advance();
  EXPECT_NEAR(poseOf(s, "a").x.y(), 3 - 1.5 - 0.1, 1e-4);
}

TEST(MjcfTendon, OfAStiffnessIsASpring) {
  Simulation s(modelOf(strung("stiffness='100' damping='20' springlength='1'", kStraight)));
  for (int frame = 0; frame < 600; ++frame) s.advance();
  EXPECT_NEAR(poseOf(s, "a").x.y(), 3 - 1 - 0.1 - 2 * 9.81 / 100, 1e-4);
}

TEST(MjcfTendon, BetweenSitesThatRepeatRepeats) {
  const Simulation s(modelOf(
      mujoco("<default><tendon range='0 1'/></default>"
             "<worldbody><replicate count='3' offset='1 0 0'><site name='up' pos='0 0 2'/>"
             "<body name='a' pos='0 0 1'><freejoint/><geom size='.1'/><site name='eye'/></body>"
             "</replicate></worldbody><tendon><spatial><site site='up'/><site site='eye'/>"
             "</spatial></tendon>")));
  EXPECT_EQ(s.world().constraintErrors().at(0).count, 3);
}

TEST(MjcfTendon, ThatGoesRoundSomethingIsTold) {
  EXPECT_TRUE(tells(modelOf(strung("", kStraight + "<site site='up'/>")),
                    "not read: <spatial> but straight from a site to another"));
  EXPECT_EQ(modelError(strung("", "<site site='up'/><site site='no'/>")),
            "m.xml:2:192: <site>: no site 'no'");
}

// To the world, whose points our words have with Y up.
TEST(MjcfSpring, OfAJointToTheWorldPullsToItsPlace) {
  Simulation s(modelOf(mujoco(
      "<option gravity='0 0 0'/><worldbody>"
      "<body name='lift' pos='1 2 3'><joint type='slide' axis='0 1 0' stiffness='100' damping='20' "
      "springref='.5'/><geom size='.1' mass='1'/></body>"
      "<body name='arm'><joint axis='0 1 0' stiffness='10' damping='4' springref='90'/>"
      "<geom size='.1' pos='1 0 0' mass='1'/></body></worldbody>")));
  for (int frame = 0; frame < 600; ++frame) s.advance();
  EXPECT_LT((poseOf(s, "lift").x - yUp(1, 2.5, 3)).norm(), 1e-4);
  EXPECT_LT((poseOf(s, "arm").x - yUp(0, 0, -1)).norm(), 1e-3);
}

}  // namespace
}  // namespace scenes
