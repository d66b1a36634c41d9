// dbd race: the verdict on made-up traces, and races of small scenes through the program.
#include <regex>

#include "app/peers/peer.h"
#include "app/race/race_page.h"
#include "app/race/race_table.h"
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

using app::Race;
using app::RaceBreak;
using app::RaceLimits;
using app::RaceTrack;

RaceTrack makeTrack(const std::string& title, int frames) {
  RaceTrack track;
  track.entry = {title, title, "", ""};
  track.samples.resize(static_cast<std::size_t>(frames));
  return track;
}

int breakOf(const RaceTrack& track, bool energyCounts = true) {
  const auto first = app::findBreak(track, RaceLimits{}, energyCounts);
  return first ? first->frame : -1;
}

TEST(RaceVerdict, IsTheFirstMeasureBeyondItsLimit) {
  RaceTrack track = makeTrack("A", 10);
  EXPECT_EQ(breakOf(track), -1);
  track.samples[7].gapShare = 0.011;
  EXPECT_EQ(breakOf(track), 7);
  track.samples[5].overlapShare = 0.11;
  EXPECT_EQ(breakOf(track), 5);
  track.samples[3].energyChange = 0.02;
  EXPECT_EQ(breakOf(track), 3);
  EXPECT_EQ(breakOf(track, false), 5);
  track.samples[2].energyChange = -0.5;  // what is lost is friction's
  EXPECT_EQ(breakOf(track), 3);
  track.missed = RaceBreak{2, "drop"};
  EXPECT_EQ(breakOf(track), 2);
  track.gaveUp = RaceBreak{10, "not finite"};
  EXPECT_EQ(breakOf(track), 2);
}

TEST(RaceVerdict, NamesWhoBrokeFirstTheOthersInTurnAndWhoHeld) {
  Race race;
  race.scene.fps = 10;
  race.frames = 21;
  for (const char* name : {"A", "B", "C", "D"}) race.tracks.push_back(makeTrack(name, 21));
  race.tracks[0].broke = RaceBreak{15, "a gap"};
  race.tracks[1].broke = RaceBreak{5, "an overlap"};
  race.tracks[2].broke = RaceBreak{5, "energy"};
  EXPECT_EQ(app::raceVerdict(race),
            "Broke first, at 0.50 s B: an overlap\nand in the same frame C: energy\n"
            "Then at 1.50 s A: a gap\nHeld for all 2 s: D\n");
}

TEST(RaceVerdict, OfNumbersThatStoppedIsTheFrameThatIsMissing) {
  RaceTrack track = makeTrack("A", 4);
  track.gaveUp = RaceBreak{4, "not finite: ball"};
  const auto broke = app::findBreak(track, RaceLimits{}, true);
  ASSERT_TRUE(broke);
  EXPECT_EQ(broke->frame, 4);
  EXPECT_EQ(broke->what, "not finite: ball");
}

TEST(RaceLayout, FitsTheFrameAndRefusesOneWithoutRoom) {
  for (const int panels : {2, 3, 4}) {
    const app::RaceLayout layout = app::layoutRace(panels, 800, 300);
    EXPECT_LE(layout.left(panels - 1) + layout.panelWidth, layout.width);
    EXPECT_LT(layout.top + layout.pictureHeight, layout.height);
  }
  EXPECT_THROW(app::layoutRace(3, 800, 40), scenes::InputError);
}

// A box falls on another: all engines have boxes, contacts and gravity.
constexpr const char* kBoxes = R"(title = "Two boxes"
duration = 0.5
[gravity]
acceleration = [0, -10, 0]
[contact]
friction = 0.5
[[body]]
shape = { plane = {} }
[[stack]]
name = "stack"
count = 2
shape = { box = { size = [1, 0.5, 1] } }
mass = 1
)";

class RaceProgram : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    if (engines().size() < 2) GTEST_SKIP() << "neither libbullet-dev nor libode-dev was found";
    writeText(folder / "boxes.toml", kBoxes);
  }
  static std::vector<std::string> engines() {
    std::vector<std::string> words = app::raceEngines();
    words.resize(std::min<std::size_t>(2, words.size()));
    return words;
  }
  static std::string two() { return engines()[0] + "," + engines()[1]; }
  Outcome race(const std::string& arguments) const {
    return run("race " + arguments + " --progress none");
  }
};

TEST_F(RaceProgram, DrawsFramesAFilmAndTables) {
  const Outcome outcome = race("boxes.toml -o r --quality draft --size 400x200 --engines " + two());
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("Held for all 0.5 s: dbd"), std::string::npos) << outcome.output;
  EXPECT_NE(readBytes(folder / "r/frames/00030.png").find("dbd race boxes.toml --engines dbd,"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "r/frames/00031.png"));
  EXPECT_TRUE(fs::exists(folder / "r/race_boxes.mp4"));
  EXPECT_EQ(lines(readBytes(folder / "r/race.csv")).size(), 1 + 2 * 31u);
  const std::string json = readBytes(folder / "r/race.json");
  EXPECT_NE(json.find("\"verdict\""), std::string::npos);
  EXPECT_NE(json.find("race_boxes.mp4"), std::string::npos);
}

// Two runs are the same but for the clock.
TEST_F(RaceProgram, MeasuresTheSameEveryTime) {
  const auto measured = [&](const std::string& name) {
    const Outcome outcome =
        race("boxes.toml --no-film --seconds 0.2 -o " + name + " --engines " + two());
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    std::string rows;
    for (const std::string& line : lines(readBytes(folder / name / "race.csv"))) {
      std::vector<std::string> row = cells(line);
      row.at(3).clear();
      for (const std::string& cell : row) rows += cell + ",";
    }
    return rows;
  };
  EXPECT_EQ(measured("a"), measured("b"));
}

TEST_F(RaceProgram, TakesRestForRest) {
  writeText(folder / "still.toml", "duration = 0.2\n[[ragdoll]]\nskeleton = \"human\"\n");
  const Outcome outcome = race("still.toml --no-film --engines " + two());
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.output.find("Broke first"), std::string::npos) << outcome.output;
}

TEST_F(RaceProgram, SaysByNameWhatAPeerCannotDo) {
  for (const auto& [scene, word] :
       {std::pair{"rope_swing", "ropes"}, std::pair{"soft_cube_drop", "soft bodies"},
        std::pair{"ragdoll_drive", "scripts"}, std::pair{"arm_reach", "no arm"}}) {
    const Outcome outcome = race(std::string(scene) + " --no-film");
    EXPECT_EQ(outcome.code, 2) << scene;
    EXPECT_NE(outcome.errors.find("fewer than two engines can run it"), std::string::npos);
    EXPECT_NE(outcome.errors.find(word), std::string::npos) << outcome.errors;
  }
}

TEST_F(RaceProgram, RefusesBadOptionsAndFoldersOfOthers) {
  EXPECT_NE(race("boxes.toml --engines dbd").errors.find("two engines"), std::string::npos);
  EXPECT_NE(race("boxes.toml --engines dbd,dbd").errors.find("twice"), std::string::npos);
  EXPECT_NE(race("boxes.toml --engines dbd,bulet").errors.find("no engine"), std::string::npos);
  EXPECT_EQ(race("boxes.toml --seconds 0").code, 2);
  EXPECT_EQ(race("boxes.toml --size 400x20").code, 2);
  EXPECT_EQ(race("boxes.toml --quality best").code, 2);
  ASSERT_EQ(run("render boxes.toml -o other --frames 0 --size 64x64 --progress none").code, 0);
  const Outcome outcome = race("boxes.toml -o other");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("not of a race"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace tests
