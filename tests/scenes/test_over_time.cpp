// over_time = ...: what reads it, and what is wrong with it at its place.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

std::string pushed(const std::string& table) {
  return "duration = 1\n" + ball("a") +
         "mass = 1\n[[force]]\nbody = \"a\"\nforce = [0, 2, 0]\nover_time = " + table + "\n";
}

double speedAfterOneSecond(const Scene& scene) {
  Simulation simulation(scene);
  for (int frame = 1; frame < scene.frameCount(); ++frame) simulation.advance();
  return simulation.world().bodies().velocity[simulation.findBody("a")].v.y();
}

TEST(OverTimeInAScene, IsReadFromPointsAndFiles) {
  EXPECT_NEAR(speedAfterOneSecond(sceneOf(pushed("[[0, 0], [1, 1]]"))), 1, 1e-9);
  const std::string saw = "{ points = [[0, 0], [0.25, 2]], repeat = true }";
  EXPECT_NEAR(speedAfterOneSecond(sceneOf(pushed(saw))), 2, 1e-9);
  const auto folder = std::filesystem::temp_directory_path() / "dbd_over_time";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "push.csv") << "# of a test\ntime,factor\n0, 1\r\n1,3\n";
  const std::string path = (folder / "scene.toml").string();
  EXPECT_NEAR(speedAfterOneSecond(parseScene(pushed("{ file = \"push.csv\" }"), path)), 4, 1e-9);
  std::ofstream(folder / "push.csv") << "0,1\n1,x\n";
  try {
    parseScene(pushed("{ file = \"push.csv\" }"), path);
    ADD_FAILURE() << "read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              (folder / "push.csv").string() + ":2: expected 'time, factor', got '1,x'");
  }
}

TEST(OverTimeInAScene, TellsWhatIsWrongAtItsPlace) {
  const auto wrong = [](const std::string& table) { return errorOf(pushed(table)); };
  EXPECT_EQ(wrong("2"),
            "test.toml:9:13: force.over_time: expected an array of [time, factor] or { "
            "points | file, repeat }, got 2");
  EXPECT_EQ(wrong("[[0, 1], [2]]"),
            "test.toml:9:22: force.over_time: expected [time, factor], got an array of 1");
  EXPECT_EQ(wrong("[]"),
            "test.toml:9:13: force.over_time: a table over time needs at least one "
            "point");
  EXPECT_EQ(wrong("[[1, 0], [0, 0]]"),
            "test.toml:9:13: force.over_time: times of a table over time must not decrease");
  EXPECT_EQ(wrong("{ points = [[0, 1]], repeat = true }"),
            "test.toml:9:13: force.over_time: a table over time that repeats must have points at "
            "two times");
  EXPECT_EQ(wrong("{ file = \"none.csv\" }"),
            "test.toml:9:22: force.over_time.file: no file 'none.csv' beside the scene");
  EXPECT_EQ(wrong("{ repeat = true }"),
            "test.toml:9:13: force.over_time: expected 'points' or 'file'");
}

TEST(OverTimeInAScene, IsOfMotorsHingesAndDrives) {
  const std::string pair = ball("a") + ball("b");
  const std::string table = "over_time = [[0, 0], [1, 1]]";
  EXPECT_EQ(errorOf(pair +
                    "[[hinge]]\nbodies = [\"a\", \"b\"]\nat = [0, 0, 0]\naxis = [1, 0, 0]\n"
                    "motor = { speed = 1, " +
                    table + " }\n"),
            "no error");
  EXPECT_EQ(errorOf(pair +
                    "[[motor_torque]]\nbodies = [\"a\", \"b\"]\naxis = [1, 0, 0]\n"
                    "stall_torque = 1\n" +
                    table + "\n"),
            "no error");
  EXPECT_EQ(errorOf(pair + "[[drive]]\nbodies = [\"a\", \"b\"]\nstiffness = 1\n" + table + "\n"),
            "test.toml:7:1: drive: a drive over time needs a target");
}

}  // namespace
}  // namespace scenes
