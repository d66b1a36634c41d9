// dbd diverge: the first frame, body and quantity in which two runs differ.
#include <nlohmann/json.hpp>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

class Diverge : public Program {
 protected:
  void simulate(const std::string& name, const std::string& more = "") const {
    ASSERT_EQ(
        run("simulate drop.toml --quiet -o " + name + " --trajectory " + name + ".csv " + more)
            .code,
        0);
  }
  void expectRefused(const std::string& arguments, const std::string& told) const {
    const Outcome outcome = run("diverge --progress none " + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_NE(outcome.errors.find(told), std::string::npos) << outcome.errors;
  }
};

TEST_F(Diverge, TheSameRunIsTheSame) {
  simulate("a");
  simulate("b", "--threads 2");
  const Outcome folders = run("diverge a b"), tables = run("diverge a.csv b.csv");
  EXPECT_EQ(folders.code, 0) << folders.errors;
  EXPECT_EQ(tables.code, 0) << tables.errors;
  EXPECT_NE(folders.output.find("the states are the same in all 20 frames"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

// One digit of one number of a table.
TEST_F(Diverge, NamesTheFrameTheBodyAndTheQuantity) {
  simulate("a");
  std::vector<std::string> rows = lines(readBytes(folder / "a.csv"));
  std::string text;
  for (std::string& row : rows) {
    std::vector<std::string> fields = cells(row);
    if (fields[0] == "7" && fields[2] == "ball") fields[12] = "0.125";  // vz
    std::string joined;
    for (const std::string& field : fields) joined += (joined.empty() ? "" : ",") + field;
    text += joined + "\n";
  }
  writeText(folder / "b.csv", text);
  const Outcome outcome = run("diverge a.csv b.csv --progress none");
  EXPECT_EQ(outcome.code, 3) << outcome.errors;
  EXPECT_NE(outcome.output.find("first different frame: 7 "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("body 'ball': vz is 0 and 0.125, by 0.125"), std::string::npos)
      << outcome.output;
  const auto json = nlohmann::json::parse(readBytes(folder / "out/diverge/diverge.json"));
  EXPECT_EQ(json.at("first").at("frame"), 7);
  EXPECT_EQ(json.at("first").at("quantity"), "vz");
  EXPECT_FALSE(json.at("same").get<bool>());
}

TEST_F(Diverge, FindsTheBodiesOfFoldersAndDrawsThem) {
  simulate("a");
  simulate("b", "--accuracy 1e-3");
  const Outcome outcome =
      run("diverge a b --scene drop.toml --quality draft --size 160x90 --progress none -o d");
  EXPECT_EQ(outcome.code, 3) << outcome.errors;
  EXPECT_NE(outcome.output.find("settings.accuracy: none -> 0.001"), std::string::npos);
  EXPECT_NE(outcome.output.find("body 'ball': "), std::string::npos) << outcome.output;
  for (const char* file : {"diverge.json", "difference.csv", "difference.png", "parting.png"}) {
    EXPECT_TRUE(fs::exists(folder / "d" / file)) << file;
  }
}

TEST_F(Diverge, ReadsMotions) {
  ASSERT_EQ(run("simulate drop.toml --quiet -o a --motion a.npz --trajectory a.csv").code, 0);
  ASSERT_EQ(run("simulate drop.toml --quiet -o b --motion b.npz --accuracy 1e-3").code, 0);
  EXPECT_EQ(run("diverge a.npz a.csv").code, 0);
  const Outcome outcome = run("diverge a.npz b.npz --progress none");
  EXPECT_EQ(outcome.code, 3) << outcome.errors;
  EXPECT_NE(outcome.output.find("body 'ball': "), std::string::npos) << outcome.output;
}

// What another program ran is compared by its hashes alone.
TEST_F(Diverge, SaysWhereBodiesAreNotKnown) {
  simulate("a");
  simulate("b");
  std::string record = readBytes(folder / "b" / "run.json");
  const std::size_t last = record.rfind('"');
  record[last - 1] = record[last - 1] == '0' ? '1' : '0';
  writeText(folder / "b" / "run.json", record);
  const Outcome outcome = run("diverge a b --scene drop.toml --progress none");
  EXPECT_EQ(outcome.code, 3) << outcome.errors;
  EXPECT_NE(outcome.output.find("first different frame: 19\n"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("b: here its scene goes otherwise from frame 19 on"),
            std::string::npos)
      << outcome.output;
}

TEST_F(Diverge, RefusesWhatCannotBeCompared) {
  simulate("a");
  simulate("fast", "--set simulation.fps=30");
  expectRefused("a nowhere", "no file or folder nowhere");
  expectRefused("a .", "holds no readable run.json");
  expectRefused("a drop.toml", "drop.toml: no trajectory");
  expectRefused("a fast", "a has 60 frames per second, fast has 30");
  expectRefused("a.csv fast.csv", "frame 1 is at");
  expectRefused("a a.csv", "the bodies of a are not known: no scene 'drop' here (--scene FILE");
  writeText(folder / "cut.csv", readBytes(folder / "a.csv").substr(0, 400));
  expectRefused("a.csv cut.csv", "cut.csv:");
  ASSERT_EQ(run("simulate chain --set duration=0.1 --quiet --trajectory chain.csv").code, 0);
  expectRefused("a.csv chain.csv", "the bodies are others");
}

}  // namespace
}  // namespace tests
