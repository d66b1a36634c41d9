// Which effects a scene has on, and the reason why each other one is off.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/constraints/constraint_item.h"
#include "scenes/effects.h"
#include "scenes/simulation.h"

namespace scenes {
namespace {

constexpr const char* kBall = "[[body]]\nname = \"ball\"\nshape = { sphere = { radius = 1 } }\n";
constexpr const char* kBox =
    "[[body]]\nname = \"box\"\nshape = { box = { size = [1, 2, 3] } }\nposition = [9, 0, 0]\n";
constexpr const char* kOtherPoint =
    "[[body]]\nname = \"other\"\nshape = { point = {} }\nmass = 1\n";
constexpr const char* kPoint = "[[body]]\nname = \"point\"\nshape = { point = {} }\nmass = 1\n";
constexpr const char* kFixed = "[[body]]\nshape = { sphere = { radius = 1 } }\nfixed = true\n";
constexpr const char* kJoint = "[[ball_socket]]\nbodies = [\"ball\", \"box\"]\nat = [4, 0, 0]\n";

const Effect& named(const std::vector<Effect>& effects, const std::string& name) {
  const auto found =
      std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.name == name; });
  if (found == effects.end()) throw std::out_of_range("no effect " + name);
  return *found;
}

Effect effect(const std::string& name, const std::string& text,
              const std::vector<std::string>& set = {}) {
  return named(effectsOf(parseScene(text, "a/test.toml", set)), name);
}

void expectOff(const Effect& e, bool leftOut, const std::string& why) {
  EXPECT_FALSE(e.on) << e.name;
  EXPECT_EQ(e.leftOut, leftOut) << e.name;
  EXPECT_EQ(e.why, why);
}
void expectOn(const Effect& e, const std::string& why, std::int64_t count) {
  EXPECT_TRUE(e.on) << e.name;
  EXPECT_EQ(e.why, why);
  EXPECT_EQ(e.count, count);
}

const std::string kTwo = std::string(kBall) + kBox;

TEST(Effects, GravityIsOnBecauseOfItsTable) {
  expectOn(effect("gravity", "\n[gravity]\n" + kTwo), "test.toml:2: [gravity]", 2);
  expectOff(effect("gravity", kTwo), false, "no [gravity]");
}

TEST(Effects, WhatTheCommandLineSwitchesOnSaysSo) {
  expectOn(effect("gravity", kBall, {"gravity.acceleration=[0,-1,0]"}),
           "--set gravity.acceleration=[0,-1,0]", 1);
}

TEST(Effects, PointsDoNotTurn) {
  expectOff(effect("rotation", kPoint), true, "all bodies are points: no rotation");
  expectOff(effect("gyroscopic_torque", kPoint), true, "all bodies are points: no rotation");
  expectOff(effect("rotation", kFixed), true, "no body can move");
  expectOn(effect("rotation", std::string(kPoint) + kBall), "test.toml:1: [[body]]", 1);
}

TEST(Effects, IsotropicInertiaHasNoGyroscopicTorque) {
  expectOff(effect("gyroscopic_torque", kBall), true, "inertia is isotropic: no gyroscopic torque");
  expectOn(effect("gyroscopic_torque", kTwo), "test.toml:1: [[body]]", 1);
  const std::vector<std::string> spinning{"simulation.inertia=spinning"};
  expectOff(effect("spinning_inertia", kBall, spinning), true,
            "no inertia changes with the orientation: M~ is M");
  expectOn(effect("spinning_inertia", kBox, spinning), "--set simulation.inertia=spinning", 1);
  expectOff(effect("spinning_inertia", kBox), false, "inertia = \"plain\"");
}

TEST(Effects, SecondOrderAndTheDirectMethodAreTheScenesChoice) {
  const std::string text = "[simulation]\nstepping = \"bdf2\"\nmethod = \"direct\"\n" + kTwo;
  expectOn(effect("second_order", text), "test.toml:2: simulation.stepping", 2);
  expectOff(effect("second_order", kTwo), false, "stepping = \"paper\"");
  expectOff(effect("direct", text), true, "no joint to solve directly");
  expectOn(effect("direct", text + kJoint), "test.toml:3: simulation.method", 1);
}

TEST(Effects, NothingOfContactIsOnWhereNothingCanTouch) {
  for (const char* name : {"broad_phase", "narrow_phase", "contact", "soft_contact", "friction",
                           "restitution", "speculative_contact"}) {
    expectOff(effect(name, kTwo), false, "no two bodies can touch: no [contact] and no plane");
    expectOff(effect(name, "[contact]\nenabled = false\n" + kTwo), false,
              "test.toml:2: contact.enabled = false");
  }
  expectOff(effect("contact", std::string("[contact]\n") + kPoint + kOtherPoint), true,
            "no two bodies can touch: all are points");
  expectOff(effect("broad_phase", "[contact]\n" + kTwo + kJoint), true,
            "no two bodies can touch: all pairs are joined or fixed");
  expectOff(effect("contact", std::string("[contact]\n") + kFixed + kFixed), true,
            "no two bodies can touch: all pairs are joined or fixed");
}

TEST(Effects, ContactIsOnBecauseOfItsTableAPlaneOrFriction) {
  expectOn(effect("contact", "[contact]\n" + kTwo), "test.toml:1: [contact]", 1);
  expectOn(effect("broad_phase", kTwo + "[[body]]\nshape = { plane = {} }\n"),
           "test.toml:8: [[body]] is a plane", 3);
  expectOn(effect("contact", std::string(kBox) + kBall + "friction = 1\n"),
           "test.toml:5: [[body]] has friction", 1);
}

TEST(Effects, FrictionIsOffWhereItIsZero) {
  expectOff(effect("friction", "[contact]\nfriction = 0\n" + kTwo), true,
            "friction 0 (test.toml:2: contact.friction)");
  expectOn(effect("friction", "[contact]\nfriction = 0.1\n" + kTwo),
           "test.toml:2: contact.friction", 1);
  // Against a body without friction another one's does not count.
  expectOff(effect("friction", std::string("[contact]\n") + kBox + kBall + "friction = 0\n"), true,
            "friction 0");
}

TEST(Effects, RestitutionAndLookingAheadAreTheContacts) {
  expectOff(effect("restitution", "[contact]\n" + kTwo), false, "restitution 0");
  expectOn(effect("restitution", "[contact]\nrestitution = 1\n" + kTwo),
           "test.toml:2: contact.restitution", 1);
  expectOff(effect("speculative_contact", "[contact]\nmargin = 0\n" + kTwo), false,
            "test.toml:2: contact.margin = 0");
  expectOff(effect("soft_contact", "[contact]\n" + kTwo), false, "no rope, cloth or soft body");
}

TEST(Effects, EveryKindOfConstraintIsInTheTable) {
  const std::vector<Effect> effects = effectsOf(parseScene(kTwo, "test.toml"));
  physics::Kinds kinds;
  physics::forEachKind(
      kinds, [&](const auto& kind) { EXPECT_FALSE(named(effects, kind.kWord).on) << kind.kWord; });
  EXPECT_EQ(named(effects, "spring").why, "no [[spring]]");
}

TEST(Effects, AKindIsOnBecauseOfTheTableThatMadeIt) {
  const Effect e = effect("ball_socket", kTwo + kJoint);
  expectOn(e, "test.toml:8: [[ball_socket]]", 1);
  EXPECT_EQ(e.rows, 3);
  EXPECT_EQ(e.stays, "what it holds together would come apart");
  expectOn(effect("link", "\n[[rope]]\nfrom = [0, 0, 0]\nto = [1, 0, 0]\ncount = 4\n"),
           "test.toml:2: [[rope]]", 3);
}

class EffectsOf : public testing::TestWithParam<std::string> {};

TEST_P(EffectsOf, LibraryScenesCanBeTakenOut) {
  const std::vector<Effect> effects = effectsOf(readScene(GetParam()));
  for (const Effect& e : effects) {
    EXPECT_FALSE(e.why.empty()) << e.name;
    if (!e.on) continue;
    EXPECT_NE(e.without.empty(), e.stays.empty()) << e.name;
    if (e.without.empty()) continue;
    EXPECT_FALSE(named(effectsOf(readScene(GetParam(), e.without)), e.name).on) << e.name;
  }
}

INSTANTIATE_TEST_SUITE_P(AllScenes, EffectsOf, testing::ValuesIn(libraryScenes()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace scenes
