// The README's commands, scene and figure are what a newcomer tries first: each is run, cut short.
#include <map>
#include <regex>

#include "app/race/race_engines.h"
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

// What makes a command short without changing what it is; "" where it is short by itself.
const std::map<std::string, std::string> kShort = {
    {"list", ""},
    {"doctor", ""},
    {"render", " --set duration=0.05 --size 96x64 --quality draft"},
    {"simulate", " --set duration=0.05"},
    {"figures", " --quality draft --width 400 --progress none"},
    {"check", " --set duration=0.02 --progress none"},
    {"golden", " pendulum --progress none"},
    {"compare", ""},
    {"plan", " --steps 2 --repeats 1"},
    {"race", " --seconds 0.05 --size 300x120 --quality draft --progress none"},
    {"study", " --quick --progress none"},
    {"words", ""},
    {"convert", ""},
    {"completion", ""},
    {"trust", " --set duration=0.05 --size 96x64 --quality draft --progress none"},
    {"diverge", " --size 96x64 --quality draft --progress none"},
};

constexpr const char* kArm =
    "<robot name='arm'><link name='base'/><link name='arm'>"
    "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>"
    "<joint name='j' type='continuous'><parent link='base'/><child link='arm'/></joint></robot>";

struct Blocks {
  std::vector<std::string> commands, scenes, figures, studies;
};

Blocks readmeBlocks() {
  Blocks blocks;
  std::string language, text;
  for (const std::string& line : lines(readBytes(fs::path(DBD_SOURCE) / "README.md"))) {
    if (line.rfind("```", 0) != 0) {
      if (language == "sh" && line.rfind("build/dbd ", 0) == 0) {
        blocks.commands.push_back(line.substr(10, line.find(" #") - 10));
      }
      text += line + "\n";
      continue;
    }
    if (language == "toml") {
      const auto has = [&](const char* word) { return text.find(word) != std::string::npos; };
      (has("[[panel]]") ? blocks.figures
       : has("[sweep]") ? blocks.studies
                        : blocks.scenes)
          .push_back(text);
    }
    language = language.empty() ? line.substr(3) : "";
    text.clear();
  }
  return blocks;
}

class Readme : public Program {};

TEST_F(Readme, EveryCommandRuns) {
  fs::create_directories(folder / "A");
  fs::create_directories(folder / "B");
  const fs::path picture = fs::path(DBD_SOURCE) / "tests/golden/pendulum/00000.png";
  fs::copy_file(picture, folder / "A" / "00000.png");
  fs::copy_file(picture, folder / "B" / "00000.png");
  const std::vector<std::string> commands = readmeBlocks().commands;
  writeText(folder / "arm.urdf", kArm);
  ASSERT_GE(commands.size(), kShort.size());
  for (std::string command : commands) {
    command.erase(command.find_last_not_of(' ') + 1);
    const std::string word = command.substr(0, command.find(' '));
    ASSERT_TRUE(kShort.contains(word)) << command << ": say here how to cut it short";
    if (word == "race" && app::raceEngines().size() < 2) continue;  // nobody to race with
    if (word == "render")
      command = std::regex_replace(command, std::regex(" --quality [a-z]+"), "");
    const Outcome outcome = run(command + kShort.at(word));
    // A scene cut short may miss what it expects of itself, and two accuracies differ; nothing else
    // may fail.
    const bool mayFail = word == "check" || word == "diverge";
    EXPECT_TRUE(outcome.code == 0 || (mayFail && outcome.code == 3))
        << command << "\nexit code " << outcome.code << "\n"
        << outcome.errors;
  }
}

TEST_F(Readme, SceneHoldsWhatItExpects) {
  const std::vector<std::string> scenes = readmeBlocks().scenes;
  ASSERT_FALSE(scenes.empty());
  for (const std::string& scene : scenes) {
    writeText(folder / "my_scene.toml", scene);
    const Outcome outcome = run("check my_scene.toml --progress none");
    EXPECT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  }
}

TEST_F(Readme, FigureIsMadeAndHolds) {
  const std::vector<std::string> figures = readmeBlocks().figures;
  ASSERT_FALSE(figures.empty());
  for (const std::string& figure : figures) {
    writeText(folder / "my.toml", figure);
    const Outcome outcome = run("figures my.toml --quality draft --width 400 --progress none");
    EXPECT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
    EXPECT_TRUE(fs::exists(folder / "out" / "my.png"));
  }
}

TEST_F(Readme, StudyIsMeasured) {
  const std::vector<std::string> studies = readmeBlocks().studies;
  ASSERT_FALSE(studies.empty());
  for (const std::string& study : studies) {
    writeText(folder / "my_case.toml", study);
    const Outcome outcome = run("study accuracy my_case.toml --quick --progress none");
    EXPECT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
    EXPECT_TRUE(fs::exists(folder / "out" / "study_accuracy" / "index.html"));
  }
}

}  // namespace
}  // namespace tests
