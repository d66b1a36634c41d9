// dbd plan: what is on, what is off, why, and what it takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "app/plan/plan.h"
#include "physics/base/profile.h"
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;
using app::PlannedEffect;
using nlohmann::json;

const app::StepEffort kLittle{3, 1, 0};

app::Plan planOf(const std::string& scene, const std::vector<std::string>& set = {}) {
  return app::makePlan(scenes::readScene(scene, set), kLittle);
}

const PlannedEffect& named(const app::Plan& plan, const std::string& name) {
  const auto found = std::find_if(plan.effects.begin(), plan.effects.end(),
                                  [&](const PlannedEffect& e) { return e.effect.name == name; });
  if (found == plan.effects.end()) throw std::out_of_range("no effect " + name);
  return *found;
}

// Words that steps of a scene turn to.
std::set<std::string> heard(const std::string& scene) {
  scenes::Simulation simulation(scenes::readScene(scene));
  std::set<std::string> words;
  const physics::Listening listening([&](const char* work) { words.insert(work); });
  for (int k = 0; k < 3; ++k) simulation.advance();
  return words;
}

TEST(Plan, ChainHasNoWorkOfContact) {
  const app::Plan plan = planOf("chain");
  for (const PlannedEffect& planned : plan.effects) {
    if (planned.effect.part != scenes::EffectPart::kContacts) continue;
    EXPECT_FALSE(planned.effect.on) << planned.effect.name;
    EXPECT_EQ(planned.effect.count, 0) << planned.effect.name;
    EXPECT_EQ(planned.bytes, 0u) << planned.effect.name;
    EXPECT_FALSE(planned.share.has_value()) << planned.effect.name;
  }
  EXPECT_EQ(plan.step.contacts, 0);
  EXPECT_EQ(plan.pairsTested, 0);
  EXPECT_EQ(plan.pairsKept, 0);
  for (const std::string& word : heard("chain")) {
    EXPECT_FALSE(word == "broad_phase" || word == "narrow_phase" || word == "contact") << word;
  }
}

TEST(Plan, StepsTellWhatTheyTurnTo) {
  for (const char* word : {"motion", "direct"}) {
    EXPECT_TRUE(heard("heavy_chain").contains(word)) << word;
  }
  for (const char* word : {"broad_phase", "narrow_phase", "contact"}) {
    EXPECT_TRUE(heard("stack").contains(word)) << word;
  }
  EXPECT_TRUE(heard("arm_reach").contains("arm"));
  EXPECT_TRUE(heard("soft_stack").contains("spring"));
}

TEST(Plan, ListeningChangesNothing) {
  scenes::Simulation alone(scenes::readScene("stack")), heard(scenes::readScene("stack"));
  const physics::Listening listening([](const char*) {});
  for (int k = 0; k < 5; ++k) heard.advance();
  {
    const physics::Listening other([](const char*) { ADD_FAILURE(); });
    const physics::Listening inner([](const char*) {});
    for (int k = 0; k < 5; ++k) alone.advance();
  }
  EXPECT_EQ(alone.stateHash(), heard.stateHash());
}

TEST(Plan, SharesSumToTheWholeStep) {
  for (const char* scene : {"chain", "stack", "flag", "spinning_tops"}) {
    const app::Plan plan = planOf(scene);
    double sum = plan.rest;
    for (const PlannedEffect& planned : plan.effects) {
      sum += planned.share.value_or(0);
      EXPECT_GE(planned.share.value_or(0), 0) << planned.effect.name;
    }
    EXPECT_NEAR(sum, 1, 1e-9) << scene;
  }
}

TEST(Plan, WhatIsOnHasAShareOrIsWithinAnother) {
  const app::Plan plan = planOf("stack");
  for (const PlannedEffect& planned : plan.effects) {
    const bool isOfStep = planned.effect.part != scenes::EffectPart::kPictures;
    const bool isMeasured =
        planned.share.has_value() || (planned.effect.on && !planned.within.empty());
    EXPECT_EQ(isMeasured, planned.effect.on && isOfStep) << planned.effect.name;
  }
  EXPECT_GT(named(plan, "contact").share.value(), 0);
  EXPECT_GT(named(planOf("chain"), "direct").share.value(), 0);
  EXPECT_EQ(named(plan, "friction").within, "contact");
}

TEST(Plan, CountsAreThoseOfTheScene) {
  const app::Plan plan = planOf("chain");
  const std::int64_t joints = named(plan, "ball_socket").effect.count;
  EXPECT_GT(joints, 0);
  EXPECT_EQ(plan.rows, 3 * joints);
  EXPECT_EQ(named(plan, "direct").effect.count, joints);
  EXPECT_EQ(plan.turning, plan.moving);
  EXPECT_GT(plan.step.evaluations, 0);
  EXPECT_EQ(plan.step.steps, 3);
  EXPECT_EQ(plan.step.repeats, 1);
}

TEST(Plan, NamesIslandsAndWhatTheirSubstepsAreAskedForBy) {
  const app::Plan chain = planOf("chain");
  ASSERT_EQ(chain.islands.size(), 1u);
  EXPECT_EQ(chain.islands[0].count, 1);
  EXPECT_EQ(chain.islands[0].plan.bodies, chain.moving);
  EXPECT_EQ(chain.islands[0].plan.trees, 1);
  EXPECT_EQ(chain.islands[0].plan.joints, named(chain, "ball_socket").effect.count);
  const app::Plan tower = planOf("tower50");
  ASSERT_EQ(tower.islands.size(), 1u);
  EXPECT_EQ(tower.islands[0].plan.contacts, 50);
  EXPECT_EQ(tower.islands[0].plan.law, physics::SubstepLaw::kSag);
  EXPECT_GT(tower.islands[0].plan.substeps, planOf("stack").islands.at(0).plan.substeps);
  const app::Plan dolls = planOf("ragdoll_pile");  // they fall, and hardly one has met another
  EXPECT_GT(dolls.islands.at(0).count, 25);
  EXPECT_EQ(dolls.islands.at(0).plan.trees, 1);
  EXPECT_EQ(planOf("cloth_hang").islands.at(0).plan.cloths, 1);
  EXPECT_EQ(planOf("soft_cube_drop").islands.at(0).plan.meshes, 1);
  EXPECT_EQ(planOf("rope_swing").islands.at(0).plan.ropes, 1);
  EXPECT_EQ(planOf("bridge").islands.at(0).plan.loops, 1);
  EXPECT_TRUE(planOf("spinning_tops").islands.at(0).plan.flies);
  EXPECT_TRUE(planOf("chain", {"simulation.method=direct"}).islands.empty());
}

TEST(Plan, NamesTheStepsThatAnAccuracyTakes) {
  for (const char* scene : {"chain", "stack"}) {
    const app::Plan plan = planOf(scene, {"simulation.accuracy=1e-3"});
    for (const app::PlannedIslands& island : plan.islands) {
      ASSERT_TRUE(island.steps.has_value()) << scene;
      EXPECT_EQ(island.steps->bodies, island.plan.bodies) << scene;
      EXPECT_GE(island.steps->steps.accepted, 1) << scene;
      EXPECT_GT(island.steps->size, 0) << scene;
      EXPECT_DOUBLE_EQ(island.steps->time, 1.0 / 60) << scene;
    }
  }
  EXPECT_FALSE(planOf("chain").islands.at(0).steps.has_value());
}

class PlanOf : public testing::TestWithParam<std::string> {};

// No step is measured: that is done above, and would take long for all of them.
TEST_P(PlanOf, FitsATerminal) {
  const app::Plan plan = app::makePlan(scenes::readScene(GetParam()), {0, 0, 0});
  const std::vector<std::string> text = lines(app::planText(plan));
  EXPECT_GT(text.size(), 8u);
  for (const std::string& line : text) EXPECT_LE(line.size(), 100u) << line;
}

std::vector<std::string> allScenes() {
  std::vector<std::string> all = scenes::libraryScenes();
  for (const auto& entry : fs::directory_iterator(fs::path(DBD_SOURCE) / "scenes/figures/panels")) {
    if (entry.path().extension() == ".toml") all.push_back(entry.path().string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

INSTANTIATE_TEST_SUITE_P(AllScenesAndPanels, PlanOf, testing::ValuesIn(allScenes()),
                         [](const auto& info) { return fs::path(info.param).stem().string(); });

class PlanCommand : public Program {};

TEST_F(PlanCommand, JsonHasTheDocumentedKeys) {
  const Outcome outcome = run("plan chain --json --steps 2 --repeats 1");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const json plan = json::parse(outcome.output);
  EXPECT_EQ(plan.at("version"), 1);
  EXPECT_EQ(plan.at("scene").at("name"), "chain");
  for (const char* key : {"seconds", "spread", "steps", "repeats", "evaluations", "sweeps",
                          "contacts", "pairs_tested", "pairs_kept", "rows", "bytes", "problem"}) {
    EXPECT_TRUE(plan.at("step").contains(key)) << key;
  }
  for (const char* key : {"all", "moving", "points", "turning"}) {
    EXPECT_TRUE(plan.at("bodies").at(key).is_number_integer()) << key;
  }
  for (const json& effect : plan.at("effects")) {
    for (const char* key : {"name", "part", "on", "left_out", "why", "count", "unit", "rows",
                            "bytes", "share", "within", "without", "stays"}) {
      EXPECT_TRUE(effect.contains(key)) << key;
    }
  }
  for (const char* key : {"broad_phase", "narrow_phase", "contact_visits", "friction_rows", "turns",
                          "gyroscopic", "moves", "rest_speeds", "made_anew"}) {
    EXPECT_TRUE(plan.at("work").at(key).is_number()) << key;
  }
  ASSERT_FALSE(plan.at("islands").empty());
  for (const json& islands : plan.at("islands")) {
    for (const char* key : {"count", "first", "bodies", "flies", "trees", "loops", "joints",
                            "ropes", "meshes", "links", "contacts", "soft_contacts", "substeps",
                            "sweeps", "asked_by", "accuracy"}) {
      EXPECT_TRUE(islands.contains(key)) << key;
    }
  }
  EXPECT_TRUE(plan.at("rest").at("share").is_number());
  EXPECT_TRUE(plan.contains("settings"));
}

TEST_F(PlanCommand, TextNamesTheLineThatSwitchesAnEffectOn) {
  const Outcome outcome = run("plan drop.toml --steps 2 --repeats 1");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("[gravity]"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("inertia is isotropic: no gyroscopic torque"), std::string::npos);
}

TEST_F(PlanCommand, MistakesAreTold) {
  const Outcome unknown = run("plan chian");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.errors.find("chain"), std::string::npos) << unknown.errors;
  EXPECT_EQ(run("plan chain --steps 0").code, 2);
  EXPECT_EQ(run("plan chain --set spring=none").code, 2);
  EXPECT_EQ(run("plan drop.toml --json --steps 1 --repeats 1 >/dev/full").code, 4);
}

}  // namespace
}  // namespace tests
