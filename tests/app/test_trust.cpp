// dbd trust: until when two runs agree, what parts them, and what is written about it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/trust/event.h"
#include "physics/small_steps/island_plan.h"
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;
using app::Allowed;
using app::BodyPair;
using app::Track;
using physics::BodyId;

constexpr int kFrames = 21;
constexpr double kFps = 10;

// Two bodies and a ground. Body 1 moves along x by `place(t)`.
template <class Place>
Track trackOf(Place place) {
  Track track;
  track.names = {"world", "ground", "one", "two"};
  for (int f = 0; f < kFrames; ++f) {
    app::TrackFrame frame;
    frame.time = f / kFps;
    frame.poses.resize(4);
    frame.velocities.resize(4);
    for (std::size_t b = 0; b < 4; ++b) {
      frame.poses[b] = physics::Pose{physics::Vec3::Zero(), physics::Quat::Identity()};
      frame.velocities[b] = physics::Velocity{physics::Vec3::Zero(), physics::Vec3::Zero()};
    }
    frame.poses[2].x.x() = place(frame.time);
    frame.velocities[2].v.x() = (place(frame.time) - place(frame.time - 1e-3)) / 1e-3;
    track.frames.push_back(frame);
  }
  return track;
}

// Each moves by itself, and may be off by 1 cm.
std::vector<Allowed> eachByItself() {
  std::vector<Allowed> allowed(4);
  for (const int b : {2, 3}) allowed[b] = {true, b, 1, 0.5, 0.01};
  return allowed;
}

int firstBeyond(const Track& a, const Track& b) {
  const auto differences = app::differencesOf(a, b, eachByItself());
  for (std::size_t f = 0; f < differences.size(); ++f) {
    if (differences[f].beyond > 0) return static_cast<int>(f);
  }
  return -1;
}

void touch(Track& track, int from, int to, const BodyPair& pair) {
  for (int f = from; f < to; ++f) track.frames[f].touching.push_back(pair);
}

TEST(TrustOfTracks, TellsTheRateOfWhatGrowsByItself) {
  constexpr double kRate = 6;
  const Track a = trackOf([](double) { return 0.0; });
  const Track b = trackOf([](double t) { return 1e-6 * std::exp(kRate * t); });
  const int beyond = firstBeyond(a, b);
  EXPECT_EQ(beyond, 16);  // ln(1e4) / 6 = 1.54 s
  const auto growth = app::growthOf(a, b, 2, eachByItself()[2], beyond);
  EXPECT_LE(growth.fromDistance, 1e-3);
  EXPECT_NEAR(growth.rate, kRate, 1e-9);
  EXPECT_FALSE(app::findEvent(a, b, eachByItself(), 2, growth).has_value());
}

TEST(TrustOfTracks, NamesTheContactAtWhichTheVelocitiesPart) {
  const auto leaves = [](double t) { return t < 1 ? 0.0 : 0.02 * (t - 1); };
  Track a = trackOf([](double) { return 0.0; }), b = trackOf(leaves);
  touch(a, 3, kFrames, {1, 2});  // long before, in both
  touch(b, 3, kFrames, {1, 2});
  touch(a, 5, kFrames, {1, 3});  // the other body's own
  touch(b, 11, kFrames, {2, 3});
  const int beyond = firstBeyond(a, b);
  ASSERT_EQ(beyond, 16);
  const auto growth = app::growthOf(a, b, 2, eachByItself()[2], beyond);
  const auto event = app::findEvent(a, b, eachByItself(), 2, growth);
  ASSERT_TRUE(event.has_value());
  EXPECT_EQ(event->kind, app::TrustEvent::Kind::kBegan);
  EXPECT_EQ(event->frame, 11);
  EXPECT_EQ(BodyPair(event->a, event->b), BodyPair(2, 3));
  EXPECT_FALSE(event->inFirst);
  EXPECT_TRUE(event->inSecond);
}

TEST(TrustOfTracks, FindsABounceBetweenTwoFrames) {
  const auto bounce = [](double speed) {
    return [speed](double t) { return t < 1.04 ? -t : -1.04 + speed * (t - 1.04); };
  };
  const Track a = trackOf(bounce(1.0)), b = trackOf(bounce(1.02));
  const int beyond = firstBeyond(a, b);
  const auto growth = app::growthOf(a, b, 2, eachByItself()[2], beyond);
  const auto event = app::findEvent(a, b, eachByItself(), 2, growth);
  ASSERT_TRUE(event.has_value());
  EXPECT_EQ(event->kind, app::TrustEvent::Kind::kJolt);
  EXPECT_EQ(event->frame, 11);
  EXPECT_TRUE(event->inFirst && event->inSecond);
}

TEST(TrustOfTracks, ATurnCountsAsFarAsItTakesASurface) {
  const physics::Pose still{physics::Vec3::Zero(), physics::Quat::Identity()};
  physics::Pose turned = still;
  turned.q = physics::Quat(std::cos(0.05), 0, 0, std::sin(0.05));
  EXPECT_NEAR(app::apart(still, turned, 2), 2 * 2 * std::sin(0.05), 1e-12);
  EXPECT_EQ(app::apart(still, turned, 0), 0);
}

// A pendulum at rest, and a ball on a stiff spring beside it.
constexpr const char* kStiffAndStill = R"(title = "Stiff and still"
duration = 0.5
[simulation]
accuracy = 1e-4
[gravity]
acceleration = [0, -9.81, 0]
[[body]]
name = "still"
shape = { sphere = { radius = 0.1 } }
mass = 1
position = [0, -1, 0]
[[ball_socket]]
bodies = ["world", "still"]
at = [0, 0, 0]
[[body]]
name = "stiff"
shape = { sphere = { radius = 0.1 } }
mass = 1
position = [2, 0, 0]
[[spring]]
bodies = ["world", "stiff"]
anchors = [[3, 0, 0], [0, 0, 0]]
stiffness = 1e6
rest_length = 0.9
)";

TEST(StepsOfIslands, AStillPendulumBesideAStiffSpringTakesNoSmallSteps) {
  scenes::Simulation simulation(scenes::parseScene(kStiffAndStill, "stiff_and_still.toml"));
  const BodyId still = simulation.findBody("still"), stiff = simulation.findBody("stiff");
  std::map<BodyId, int> taken;
  const physics::StepListening listening(
      [&](const physics::IslandSteps& told) { taken[told.first] += told.steps.accepted; });
  constexpr int kSteps = 30;
  for (int k = 0; k < kSteps; ++k) simulation.advance();
  EXPECT_EQ(taken[still], kSteps);
  EXPECT_GT(taken[stiff], 5 * kSteps);
}

class Trust : public Program {
 protected:
  nlohmann::json jsonOf(const fs::path& run) const {
    return nlohmann::json::parse(readBytes(folder / run / "trust.json"));
  }
};

TEST_F(Trust, WritesLinesTablesAChartAndFramesOfBoth) {
  const Outcome outcome = run("trust drop.toml --quality draft --size 160x90 --progress none");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("drop: accuracy 0.01 (the scene states none), compared with "
                                "accuracy 0.001\ntrusted "),
            std::string::npos)
      << outcome.output;
  const fs::path out = folder / "out" / "trust_drop";
  EXPECT_EQ(lines(readBytes(out / "difference.csv")).size(), 21u);
  EXPECT_EQ(folderBytes(out / "frames").size(), 20u);
  EXPECT_TRUE(fs::exists(out / "difference.png"));
  const nlohmann::json json = jsonOf("out/trust_drop");
  EXPECT_EQ(json.at("accuracy"), 0.01);
  EXPECT_TRUE(json.at("accuracy_chosen").get<bool>());
  EXPECT_EQ(json.at("bodies").size(), 1u);
  EXPECT_EQ(json.at("first_apart").is_null(), json.at("whole").get<bool>());
}

TEST_F(Trust, ADoublePendulumPartsByItself) {
  const Outcome outcome = run("trust double_pendulum --accuracy 1e-6 --no-film --progress none");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("event: no contact: it grows by itself"), std::string::npos)
      << outcome.output;
  const nlohmann::json json = jsonOf("out/trust_double_pendulum");
  EXPECT_GT(json.at("trusted_until").get<double>(), 1);
  EXPECT_LT(json.at("trusted_until").get<double>(), 10);
  EXPECT_GT(json.at("growth").at("rate").get<double>(), 0);
  EXPECT_FALSE(fs::exists(folder / "out" / "trust_double_pendulum" / "frames"));
}

TEST_F(Trust, WhatNoAccuracyStepsGetsATenthOfTheFrame) {
  const Outcome outcome =
      run("trust drop.toml --set simulation.method=direct --no-film --progress none");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("600 fps (no accuracy steps method = \"direct\")"),
            std::string::npos)
      << outcome.output;
}

TEST_F(Trust, RefusesAnAccuracyOfWhichNoTenthIsLeft) {
  const Outcome outcome = run("trust drop.toml --accuracy 1e-12 --no-film");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("expected at least 1e-11"), std::string::npos) << outcome.errors;
  EXPECT_EQ(run("trust drop.toml --frames 90:95").code, 2);
  EXPECT_EQ(run("trust drop.toml --video --no-film").code, 2);
}

TEST_F(Trust, AFilmTellsWhereItEnds) {
  const std::string arguments = "render drop.toml --quality draft --size 160x90 --progress none ";
  const Outcome outcome = run(arguments + "--trust -o film");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_TRUE(fs::exists(folder / "film" / "trust.json"));
  const auto record = nlohmann::json::parse(readBytes(folder / "film" / "run.json"));
  EXPECT_EQ(record.at("picture").at("trusted_until"), jsonOf("film").at("trusted_until"));
  EXPECT_EQ(record.at("accuracy").at("asked"), 0.01);
  EXPECT_GT(record.at("accuracy").at("accepted_steps"), 0);
  EXPECT_EQ(run(arguments + "--hud -o film").code, 2);  // other frames
}

TEST_F(Trust, StepsAreDrawnWhereAnAccuracyIsAskedFor) {
  EXPECT_EQ(run("simulate drop.toml --steps-chart steps.png").code, 2);
  EXPECT_EQ(run("simulate drop.toml --steps-chart steps.png --accuracy 1e-3 --quiet").code, 0);
  EXPECT_TRUE(fs::exists(folder / "steps.png"));
}

}  // namespace
}  // namespace tests
