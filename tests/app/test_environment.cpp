// A full disk, a folder that cannot be written, a closed pipe: exit code 4, told clearly, no half
// file.
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSheet = R"(title = "A fall"
claim = "Things fall."
[[panel]]
name = "fall"
scene = "./drop.toml"
frames = [0, 10]
)";
constexpr const char* kCase = R"(title = "A ball falls"
about = "How far it falls."
scene = "./drop.toml"
fps = 10
duration = 0.3
[[quantity]]
metric = "y"
body = "ball"
law = [0.6, 0, -4.905]
[sweep]
methods = ["paper"]
steps = [1, 2, 4]
)";

class Environment : public Program {
 protected:
  void expectTold(const Outcome& outcome, const std::string& told) const {
    EXPECT_EQ(outcome.code, 4) << outcome.errors;
    EXPECT_NE(outcome.errors.find(told), std::string::npos) << outcome.errors;
  }
  void expectNoHalfFile() const {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
    }
  }
};

TEST_F(Environment, AFullDeviceIsToldForTables) {
  expectTold(run("simulate drop.toml --trajectory /dev/full"), "No space left");
  expectTold(run("simulate drop.toml --metrics /dev/full"), "No space left");
}

TEST_F(Environment, AFullDeviceIsToldForStandardOutput) {
  expectTold(run("list > /dev/full"), "No space left");
  expectTold(run("simulate drop.toml --trajectory - > /dev/full"), "No space left");
}

TEST_F(Environment, AClosedStandardOutputIsTold) { expectTold(run("list >&-"), "standard output"); }

// As in `dbd words | head -1`: the program ends by itself, and quietly.
TEST_F(Environment, AClosedPipeEndsEveryCommandThatWritesToIt) {
  for (const std::string command : {"simulate drop.toml --set duration=60 --trajectory -",
                                    "simulate drop.toml --metrics - --set duration=60", "words"}) {
    const Outcome outcome = run(command + " ; echo $? > code ; } | { head -1");
    EXPECT_EQ(readBytes(folder / "code"), "4\n") << command;
    EXPECT_EQ(outcome.errors.find("dbd:"), std::string::npos) << outcome.errors;
  }
}

TEST_F(Environment, FiguresAndStudiesThatCannotBeWrittenAreTold) {
  writeText(folder / "sheet.toml", kSheet);
  writeText(folder / "case.toml", kCase);
  const std::string figures = "figures sheet.toml --quality draft --width 320 --quiet -o ";
  const std::string study = "study accuracy case.toml --progress none -o ";
  for (const std::string& command : {figures, study}) {
    expectTold(run(command + "/proc/out"), "/proc/out");
    expectTold(run(command + "run", "ulimit -f 1;"), "cannot write");
    expectNoHalfFile();
    EXPECT_EQ(run(command + "run").code, 0);
    fs::remove_all(folder / "run");
  }
}

TEST_F(Environment, AFileInThePlaceOfTheFolderIsTold) {
  writeText(folder / "taken", "a file");
  expectTold(run("render drop.toml --quality draft -o taken"), "taken");
  expectTold(run("render drop.toml --quality draft -o taken/deeper"), "taken");
  expectTold(run("simulate drop.toml --trajectory taken/t.csv"), "taken");
  EXPECT_EQ(readBytes(folder / "taken"), "a file");
}

TEST_F(Environment, AReadOnlyFolderIsTold) {  // /proc refuses even root
  expectTold(run("render drop.toml --quality draft -o /proc/out"), "/proc/out");
  expectTold(run("simulate drop.toml --trajectory /proc/t.csv"), "/proc/t.csv");
}

// A limit on the size of files stops writing in the middle, as a full disk does.
TEST_F(Environment, AnImageThatDoesNotFitLeavesNoHalfFileAndTheRunGoesOn) {
  const std::string arguments = "render drop.toml --quiet --size 1280x720 --threads 2 -o run";
  expectTold(run(arguments, "ulimit -f 4;"), "motion.npz");
  expectNoHalfFile();
  expectTold(run(arguments, "ulimit -f 40;"), "frames/");
  expectNoHalfFile();
  EXPECT_TRUE(folderBytes(folder / "run" / "frames").empty());
  EXPECT_EQ(run(arguments).code, 0);
  EXPECT_EQ(folderBytes(folder / "run" / "frames").size(), 20u);
}

TEST_F(Environment, ATableThatDoesNotFitLeavesNoHalfFile) {
  expectTold(run("simulate drop.toml --set duration=5 --trajectory t.csv", "ulimit -f 4;"),
             "t.csv");
  expectNoHalfFile();
  EXPECT_FALSE(fs::exists(folder / "t.csv"));
}

TEST_F(Environment, VideoWithoutFfmpegIsToldBeforeAnythingIsDrawn) {
  expectTold(run("render drop.toml --video -o run", "PATH=/nowhere"), "apt-get install -y ffmpeg");
  EXPECT_FALSE(fs::exists(folder / "run" / "frames"));
}

}  // namespace
}  // namespace tests
