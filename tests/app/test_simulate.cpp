// The tables that `dbd simulate` writes.
#include "program.h"

namespace tests {
namespace {

constexpr int kFrames = 20;

class Simulate : public Program {};

TEST_F(Simulate, TrajectoryHasARowPerBodyAndFrameFromTheStart) {
  ASSERT_EQ(run("simulate drop.toml --trajectory t.csv").code, 0);
  const std::vector<std::string> rows = lines(readBytes(folder / "t.csv"));
  ASSERT_EQ(rows.size(), 1u + 2 * kFrames);
  EXPECT_EQ(rows[0], "frame,time,body,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz");
  EXPECT_EQ(rows[2], "0,0,ball,0,0.59999999999999998,0,1,0,0,0,1,0,0,0,0,0");
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::vector<std::string> row = cells(rows[2 + 2 * frame]);
    ASSERT_EQ(row.size(), 16u);
    EXPECT_EQ(row[0], std::to_string(frame));
    EXPECT_EQ(std::stod(row[1]), frame / 60.0);
    EXPECT_EQ(row[2], "ball");
  }
}

TEST_F(Simulate, WritesOverNothingThatItReadsOrWrites) {
  const std::string scene = readBytes(folder / "drop.toml");
  for (const char* option : {"--trajectory", "--metrics", "--motion", "--steps-chart"}) {
    const Outcome outcome = run(std::string("simulate drop.toml ") + option + " ./drop.toml");
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_NE(outcome.errors.find(option), std::string::npos) << outcome.errors;
    EXPECT_EQ(readBytes(folder / "drop.toml"), scene) << option;
  }
  const Outcome twice = run("simulate drop.toml --trajectory x.csv --metrics ./x.csv");
  EXPECT_EQ(twice.code, 2);
  EXPECT_NE(twice.errors.find("--trajectory writes that file"), std::string::npos);
  EXPECT_EQ(run("simulate drop.toml --motion /dev/null").code, 2);
}

TEST_F(Simulate, MetricsHaveARowPerFrame) {
  ASSERT_EQ(run("simulate drop.toml --metrics m.csv").code, 0);
  const std::vector<std::string> rows = lines(readBytes(folder / "m.csv"));
  ASSERT_EQ(rows.size(), 1u + kFrames);
  EXPECT_EQ(rows[0].rfind("frame,time,kinetic,potential,total,px,py,pz,lx,ly,lz", 0), 0u);
  EXPECT_NE(rows[0].find(",overlap,contacts,iterations,"), std::string::npos);
  EXPECT_EQ(cells(rows[0]).size(), cells(rows[1]).size());
  const std::vector<std::string> start = cells(rows[1]);
  EXPECT_DOUBLE_EQ(std::stod(start[2]), 1.0);               // 2 kg at 1 m/s
  EXPECT_NEAR(std::stod(start[3]), 2 * 9.81 * 0.6, 1e-12);  // above the origin
}

TEST_F(Simulate, HashIsTheLastLineAndTheSameInEveryRun) {
  const Outcome first = run("simulate drop.toml --hash --trajectory a.csv");
  const Outcome second = run("simulate drop.toml --hash --quiet --threads 2 --trajectory b.csv");
  ASSERT_EQ(first.code, 0);
  ASSERT_EQ(lines(second.output).size(), 1u);
  EXPECT_EQ(lines(first.output).back(), lines(second.output).back());
  EXPECT_EQ(lines(second.output).back().size(), 16u);
  EXPECT_EQ(readBytes(folder / "a.csv"), readBytes(folder / "b.csv"));
}

// glibc picks variants of its functions by processor: nothing of them may reach the state.
TEST_F(Simulate, HashIsTheSameForTheCLibrarysVariants) {
  for (const char* scene : {"ragdoll_drive", "arch", "card_house"}) {
    const std::string simulate =
        std::string("simulate ") + scene + " --set duration=0.5 --hash --quiet";
    const Outcome any = run(simulate);
    const Outcome plain =
        run(simulate, "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable,-FMA4");
    ASSERT_EQ(any.code, 0) << any.errors;
    EXPECT_EQ(any.output, plain.output) << scene;
  }
}

TEST_F(Simulate, OverridesChangeTheMotion) {
  const Outcome plain = run("simulate drop.toml --hash --quiet");
  const Outcome changed = run(
      "simulate drop.toml --hash --quiet --set gravity.acceleration=[0,-5,0] --set duration=0.2");
  EXPECT_EQ(changed.code, 0) << changed.errors;
  EXPECT_NE(plain.output, changed.output);
}

TEST_F(Simulate, DashWritesTheTableToStandardOutputAndNothingElse) {
  ASSERT_EQ(run("simulate drop.toml --trajectory t.csv").code, 0);
  const Outcome outcome = run("simulate drop.toml --trajectory -");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.output, readBytes(folder / "t.csv"));
  EXPECT_EQ(run("simulate drop.toml --trajectory - --metrics -").code, 2);
}

TEST_F(Simulate, RunJsonTellsWhatWasRun) {
  ASSERT_EQ(run("simulate drop.toml -o here").code, 0);
  const std::string record = readBytes(folder / "here" / "run.json");
  for (const char* key : {"\"version\"", "\"flags\"", "\"text_hash\"", "\"substeps\"",
                          "\"state_hashes\"", "\"expectations\"", "\"holds\": true"}) {
    EXPECT_NE(record.find(key), std::string::npos) << key;
  }
}

TEST_F(Simulate, NumbersThatFailEndTheRunWithThreeAndKeepTheTable) {
  const std::string text = readBytes(folder / "drop.toml");
  writeText(folder / "fast.toml", text + R"([[body]]
name = "top"
shape = { box = { size = [1, 2, 3] } }
mass = 1
position = [0, 50, 0]
angular_velocity = [1e170, 1e170, 0]
)");
  const Outcome outcome = run("simulate fast.toml --quiet --trajectory t.csv");
  EXPECT_EQ(outcome.code, 3);
  for (const char* told : {"fast", "frame 0", "'top'"}) {
    EXPECT_NE(outcome.errors.find(told), std::string::npos) << outcome.errors;
  }
  EXPECT_EQ(lines(readBytes(folder / "t.csv")).size(), 4u);  // the start of three bodies
}

TEST_F(Simulate, ProgressAsJsonIsOneObjectPerLine) {
  const Outcome outcome = run("simulate drop.toml --progress json");
  ASSERT_FALSE(outcome.errors.empty());
  for (const std::string& line : lines(outcome.errors)) {
    EXPECT_EQ(line.front(), '{');
    EXPECT_EQ(line.back(), '}');
  }
  EXPECT_TRUE(run("simulate drop.toml --quiet").errors.empty());
}

}  // namespace
}  // namespace tests
