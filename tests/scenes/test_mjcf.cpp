// MJCF, feature by feature, against what its reference says.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "scenes/models/read_model.h"
#include "tests/scenes/model_text.h"

namespace scenes {
namespace {

using physics::Vec3;

constexpr double kExact = 1e-12;

TEST(Mjcf, PutsAGeomWhereItsBodyAndItselfSay) {
  const Simulation s(
      modelOf(world("<body name='a' pos='1 2 3' euler='0 0 90'><freejoint/>"
                    "<geom type='box' size='.1 .2 .3' pos='.5 0 0'/></body>")));
  EXPECT_NEAR((poseOf(s, "a").x - yUp(1, 2.5, 3)).norm(), 0, kExact);
  const Vec3 along = poseOf(s, "a").q * Vec3::UnitX();  // the box's x is the world's y
  EXPECT_NEAR((along - yUp(0, 1, 0)).norm(), 0, kExact);
}

class MjcfOrientation : public testing::TestWithParam<const char*> {};

TEST_P(MjcfOrientation, SaysTheSameInEveryWay) {
  const std::string text = std::string("<body name='a' ") + GetParam() +
                           "><freejoint/><geom type='box' size='.1 .2 .3'/></body>";
  const Simulation s(modelOf(world(text)));
  EXPECT_NEAR((poseOf(s, "a").q * Vec3::UnitZ() - yUp(0, -1, 0)).norm(), 0, 1e-7);
  EXPECT_NEAR((poseOf(s, "a").q * Vec3::UnitX() - yUp(1, 0, 0)).norm(), 0, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Ways, MjcfOrientation,
                         testing::Values("quat='0.70710678 0.70710678 0 0'", "axisangle='1 0 0 90'",
                                         "euler='90 0 0'", "xyaxes='2 0 0 0.5 0 3'",
                                         "zaxis='0 -2 0'"));

TEST(Mjcf, TurnsEulerAnglesInTheSequenceAndUnitThatTheCompilerSays) {
  const auto tip = [](const std::string& compiler, const std::string& euler) {
    const Simulation s(modelOf(mujoco(compiler + "<worldbody><body name='a' euler='" + euler +
                                      "'><freejoint/><geom type='box' size='.1 .2 .3'/></body>"
                                      "</worldbody>")));
    return (poseOf(s, "a").q * Vec3::UnitZ()).eval();
  };
  // About x, then about the turned z: the tip of z goes to -y and then to x.
  EXPECT_NEAR((tip("", "90 0 0") - yUp(0, -1, 0)).norm(), 0, kExact);
  EXPECT_NEAR((tip("<compiler eulerseq='zxy'/>", "90 90 0") - yUp(1, 0, 0)).norm(), 0, kExact);
  EXPECT_NEAR((tip("<compiler eulerseq='XZY'/>", "90 90 0") - yUp(1, 0, 0)).norm(), 0, kExact);
  EXPECT_NEAR((tip("<compiler angle='radian'/>", "1.5707963267948966 0 0") - yUp(0, -1, 0)).norm(),
              0, kExact);
}

TEST(Mjcf, TakesWhatAClassSaysFromTheNearestThatSaysIt) {
  const std::string defaults =
      "<default><geom type='box' size='1 1 1' density='1'/>"
      "<default class='small'><geom size='.5 .5 .5'/>"
      "<default class='heavy'><geom density='8'/></default></default></default>";
  const Simulation s(modelOf(mujoco(
      defaults +
      "<worldbody><body name='a'><freejoint/><geom/></body>"
      "<body name='b' pos='5 0 0' childclass='small'><freejoint/><geom/></body>"
      "<body name='c' pos='9 0 0' childclass='small'><freejoint/><geom class='heavy'/></body>"
      "</worldbody>")));
  const auto mass = [&](const char* body) {
    return s.world().bodies().mass[static_cast<std::size_t>(s.findBody(body))];
  };
  EXPECT_NEAR(mass("a"), 8, kExact);
  EXPECT_NEAR(mass("b"), 1, kExact);
  EXPECT_NEAR(mass("c"), 8, kExact);
}

TEST(Mjcf, MakesAHalfSizeAFullOne) {
  const Simulation s(
      modelOf(world("<body name='a'><freejoint/>"
                    "<geom type='capsule' size='.1 .4'/></body>")));
  const auto& shape = s.world().bodies().shape[static_cast<std::size_t>(s.findBody("a"))];
  ASSERT_TRUE(std::holds_alternative<physics::Capsule>(shape));
  EXPECT_EQ(std::get<physics::Capsule>(shape).length, 0.8);
  EXPECT_NEAR((poseOf(s, "a").q * Vec3::UnitY() - yUp(0, 0, 1)).norm(), 0, kExact);
}

TEST(Mjcf, SpansACapsuleBetweenTwoPoints) {
  const Simulation s(
      modelOf(world("<body name='a'><freejoint/>"
                    "<geom type='capsule' size='.1' fromto='1 0 0 1 2 0'/></body>")));
  EXPECT_NEAR((poseOf(s, "a").x - yUp(1, 1, 0)).norm(), 0, kExact);
  EXPECT_NEAR(std::abs((poseOf(s, "a").q * Vec3::UnitY()).dot(yUp(0, 1, 0))), 1, kExact);
}

TEST(Mjcf, KeepsAHingeWithinItsRange) {
  Simulation s(
      modelOf(world("<body name='a'><joint axis='0 1 0' range='-30 30'/>"
                    "<geom type='capsule' size='.05' fromto='0 0 0 1 0 0'/></body>")));
  for (int k = 0; k < 120; ++k) s.advance();
  const Vec3 out = s.world().bodies().pose.back().x.normalized();  // it fell, and was caught
  EXPECT_NEAR(std::asin(out.y()) * 180 / M_PI, -30, 0.1);
}

TEST(Mjcf, JoinsThreeHingesOfABodyByRingsThatShareItsMass) {
  Simulation s(modelOf(
      world("<body name='a'><joint axis='1 0 0'/><joint axis='0 1 0' range='-20 20'/>"
            "<joint axis='0 0 1'/><geom type='capsule' size='.05' fromto='0 0 0 .8 0 0' mass='2'/>"
            "</body>")));
  const auto& mass = s.world().bodies().mass;
  EXPECT_EQ(s.world().bodyCount(), 4);
  EXPECT_NEAR(mass[1] + mass[2] + mass[3], 2, kExact);
  for (int k = 0; k < 120; ++k) s.advance();
  const auto gap = [&](const char* from, const char* to) {
    return poseOf(s, from).q.angularDistance(poseOf(s, to).q) * 180 / M_PI;
  };
  EXPECT_LT(gap("a.ring0", "a.ring1"), 20.1);  // the second hinge is between the rings
  EXPECT_LT((poseOf(s, "a").x.norm() - 0.4), 1e-5);
}

TEST(Mjcf, SlidesAlongAnAxisAgainstASpring) {
  Simulation s(
      modelOf(world("<body name='a'><joint type='slide' axis='0 0 1' stiffness='100'"
                    " damping='20'/><geom size='.1' mass='2'/></body>")));
  for (int k = 0; k < 600; ++k) s.advance();
  EXPECT_NEAR(poseOf(s, "a").x.y(), -2 * 9.81 / 100, 1e-3);  // m g = k x
  EXPECT_NEAR(std::hypot(poseOf(s, "a").x.x(), poseOf(s, "a").x.z()), 0, 1e-6);
}

TEST(Mjcf, HoldsAPositionWithAServo) {
  Simulation s(modelOf(
      mujoco("<worldbody><body name='a'><joint name='j' axis='0 1 0'/>"
             "<geom type='capsule' size='.05' fromto='0 0 0 1 0 0'/>"
             "<inertial pos='.5 0 0' mass='1' diaginertia='.01 .08 .08'/></body></worldbody>"
             "<actuator><position joint='j' kp='1000' kv='50'/></actuator>")));
  for (int k = 0; k < 300; ++k) s.advance();
  const double sag = std::atan2(-poseOf(s, "a").x.y(), poseOf(s, "a").x.x());
  EXPECT_NEAR(sag, 9.81 * 0.5 * std::cos(sag) / 1000, 1e-5);  // m g r cos = k angle
}

TEST(Mjcf, LeavesAMotorStillUntilItIsToldATorque) {
  const std::string text = mujoco(
      "<option gravity='0 0 0'/><worldbody><body name='a'><joint name='j' axis='0 0 1'/>"
      "<geom type='box' size='.1 .1 .1'/></body></worldbody>"
      "<actuator><motor name='m' joint='j'/></actuator>");
  Simulation still(parseScene(text, "m.xml"));
  const std::string told[] = {"motor_torque.m.stall_torque=1"};
  Simulation driven(parseScene(text, "m.xml", told));
  still.advance();
  driven.advance();
  EXPECT_LT(still.world().bodies().velocity[1].w.norm(), 1e-15);
  EXPECT_GT(driven.world().bodies().velocity[1].w.y(), 0.1);  // about z, which is up
}

TEST(Mjcf, LetsOnlyTouchWhatItsBitsAndExcludesLet) {
  const auto pairs = [](const std::string& a, const std::string& b, const std::string& more) {
    const Simulation s(modelOf(mujoco("<worldbody><body name='a'><freejoint/><geom size='1' " + a +
                                      "/></body><body name='b'><freejoint/><geom size='1' " + b +
                                      "/></body></worldbody>" + more)));
    return s.world().ignoredPairs().size();
  };
  EXPECT_EQ(pairs("", "", ""), 0u);
  EXPECT_EQ(pairs("contype='2'", "conaffinity='1' contype='4'", ""), 1u);
  EXPECT_EQ(pairs("contype='2'", "conaffinity='2' contype='0'", ""), 0u);
  EXPECT_EQ(pairs("", "", "<contact><exclude body1='a' body2='b'/></contact>"), 1u);
  EXPECT_EQ(pairs("contype='0' conaffinity='0'", "", ""), 2u);  // the world is a body too
}

TEST(Mjcf, FixesWhatHasNoJointAndDropsWhatIsFree) {
  Simulation s(
      modelOf(world("<geom name='floor' type='plane' size='0 0 1'/>"
                    "<body name='shelf' pos='0 0 2'><geom type='box' size='1 1 .1'/></body>"
                    "<body name='ball' pos='5 0 1'><freejoint/><geom size='.2'/></body>")));
  for (int k = 0; k < 300; ++k) s.advance();
  EXPECT_EQ(poseOf(s, "shelf").x.y(), 2);
  EXPECT_NEAR(poseOf(s, "ball").x.y(), 0.2, 1e-3);
}

TEST(Mjcf, ClosesLoopsByEqualities) {
  Simulation s(
      modelOf(mujoco("<worldbody><body name='a'><joint axis='0 1 0'/>"
                     "<geom type='capsule' size='.05' fromto='0 0 0 1 0 0'/></body></worldbody>"
                     "<equality><connect body1='a' anchor='1 0 0'/></equality>")));
  for (int k = 0; k < 60; ++k) s.advance();
  EXPECT_NEAR(poseOf(s, "a").x.y(), 0, 1e-6);  // held at both ends
}

TEST(Mjcf, RepeatsAndFramesWhatIsInside) {
  const Simulation s(
      modelOf(world("<replicate count='3' offset='0 0 1' sep='-'><frame pos='2 0 0'>"
                    "<body name='a'><freejoint/><geom size='.1'/></body></frame>"
                    "</replicate>")));
  EXPECT_NEAR((poseOf(s, "a-2").x - yUp(2, 0, 2)).norm(), 0, kExact);
}

TEST(Mjcf, MakesAHullOfAMeshAndAnEllipsoid) {
  const Simulation s(modelOf(mujoco(
      "<asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1 .1 .1 .1' scale='2 2 2'/></asset>"
      "<worldbody><body name='a'><freejoint/><geom type='mesh' mesh='m'/></body>"
      "<body name='b' pos='9 0 0'><freejoint/><geom type='ellipsoid' size='1 2 3'/></body>"
      "</worldbody>")));
  const auto mass = [&](const char* body) {
    return s.world().bodies().mass[static_cast<std::size_t>(s.findBody(body))];
  };
  EXPECT_NEAR(mass("a"), 1000 * 8.0 / 6, 1e-9);
  EXPECT_NEAR((poseOf(s, "a").x - yUp(.5, .5, .5)).norm(), 0, 1e-9);
  EXPECT_NEAR(mass("b") / (1000 * 4.0 / 3 * M_PI * 6), 1, 0.05);  // by 162 points
}

TEST(Mjcf, TellsWhatItDoesNotReadOnceAndWhere) {
  const Scene scene =
      modelOf(mujoco("<statistic extent='2'/>\n"
                     "<worldbody>\n<body name='a'><freejoint/>\n<geom size='1' condim='1'/>\n"
                     "<camera name='s'/></body>\n<body name='b' pos='4 0 0'><freejoint/>\n"
                     "<geom size='1' condim='3'/></body></worldbody>"));
  const std::vector<std::string> expected = {"m.xml:2: not read: <statistic>",
                                             "m.xml:5: not read: condim of <geom> (also line 8)",
                                             "m.xml:6: not read: <camera>"};
  EXPECT_EQ(scene.told, expected);
}

TEST(Mjcf, RefusesWithTheLineAndWhatIsWanted) {
  EXPECT_EQ(modelError(world("<geom type='bax' size='1'/>")),
            "m.xml:3:2: <geom>: type: unknown 'bax'; did you mean 'box'?");
  EXPECT_EQ(modelError(world("<geom type='box' size='1 x 1'/>")),
            "m.xml:3:2: <geom>: size: expected numbers, got '1 x 1'");
  EXPECT_EQ(modelError(world("<body name='a'><joint/></body>")),
            "m.xml:3:2: body 'a' moves: expected a mass > 0, of its own or of its shapes");
  EXPECT_EQ(modelError(world("<geom type='mesh' mesh='x'/>")), "m.xml:3:2: <geom>: no mesh 'x'");
  EXPECT_EQ(modelError(world("<geom type='ellipsoid' size='9e18 .1 .1'/>")),
            "m.xml:3:2: <geom>: convex hull: the points lie in one plane, on one line or in one "
            "point");
  EXPECT_EQ(modelError(mujoco("<worldbody")),
            "m.xml:3:1: expected XML: Error parsing start element tag");
  EXPECT_EQ(modelError("<html/>"),
            "m.xml:1:2: expected <mujoco> (MJCF) or <robot> (URDF), got <html>");
}

TEST(Mjcf, IsTheSameSceneConverted) {
  const Scene read = modelOf(
      world("<geom type='plane' size='0 0 1'/><body name='a \"b\"' pos='0 0 1' euler='10 20 30'>"
            "<freejoint/><geom type='cylinder' size='.2 .3' rgba='.2 .4 .6 1'/></body>"
            "<body name='c' pos='0 .1 3'><joint axis='1 0 0' damping='.1'/>"
            "<geom type='box' size='.3 .2 .1' pos='0 .3 .1'/></body>"));
  Simulation own(read), converted(parseScene(read.text, "m.toml"));
  for (int k = 0; k < 90; ++k) own.advance(), converted.advance();
  EXPECT_EQ(own.stateHash(), converted.stateHash());
}

}  // namespace
}  // namespace scenes
