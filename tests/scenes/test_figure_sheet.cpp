// Figure sheets: what they say is read, and what is wrong in them is told at its place.
#include <gtest/gtest.h>

#include "scenes/figure/figure_sheet.h"

namespace scenes {
namespace {

const std::string kSheetHead = "title = \"t\"\nclaim = \"c\"\n";
const std::string kPanel = "[[panel]]\nname = \"p\"\nscene = \"pendulum\"\n";

FigureSheet sheetOf(const std::string& text) { return parseFigureSheet(text, "sheet.toml"); }

std::string sheetErrorOf(const std::string& text) {
  try {
    sheetOf(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FigureSheet, PanelsAndPlotsStandInTheOrderOfTheFile) {
  const FigureSheet sheet = sheetOf(
      kSheetHead + kPanel + "frames = [0, 5]\n[[plot]]\n[[plot.curve]]\npanel = \"p\"\nmetric = " +
      "\"max_speed\"\n[[panel]]\nscene = \"pendulum\"\n");
  ASSERT_EQ(sheet.tiles.size(), 4u);
  EXPECT_FALSE(sheet.tiles[1].isPlot);
  EXPECT_FALSE(sheet.tiles[1].first);
  EXPECT_TRUE(sheet.tiles[2].isPlot);
  EXPECT_EQ(sheet.panels[1].name, "c");
  EXPECT_EQ(sheet.panels[1].frames.front(), sheet.runs[0].scene.frameCount() - 1);
}

TEST(FigureSheet, OneSceneWithTheSameSettingsIsSimulatedOnce) {
  const std::string changed = "[[panel]]\nscene = \"pendulum\"\nset = [\"duration=1\"]\n";
  EXPECT_EQ(sheetOf(kSheetHead + kPanel + kPanel).runs.size(), 1u);
  EXPECT_EQ(sheetOf(kSheetHead + kPanel + changed + changed).runs.size(), 2u);
}

TEST(FigureSheet, AnOnionSkinIsOneTile) {
  const FigureSheet sheet =
      sheetOf(kSheetHead + "layout = \"onion_skin\"\n" + kPanel + "frames = [0, 5, 9]\n");
  ASSERT_EQ(sheet.tiles.size(), 1u);
  EXPECT_EQ(sheet.tiles[0].frames, (std::vector<int>{0, 5, 9}));
}

TEST(FigureSheet, TimesAreFrames) {
  const FigureSheet sheet = sheetOf(kSheetHead + kPanel + "times = [0, 0.5]\n");
  EXPECT_EQ(sheet.panels[0].frames, (std::vector<int>{0, 30}));
}

TEST(FigureSheet, NamesTheNearestKeyForAnUnknownOne) {
  EXPECT_EQ(sheetErrorOf(kSheetHead + kPanel + "frame = [0]\n"),
            "sheet.toml:6:1: panel: unknown key 'frame'; did you mean 'frames'?");
  EXPECT_EQ(sheetErrorOf(kSheetHead + "[[pannel]]\n"),
            "sheet.toml:3:3: unknown table 'pannel'; did you mean 'panel'?");
}

TEST(FigureSheet, NamesTheNearestPanelForAnUnknownOne) {
  EXPECT_EQ(sheetErrorOf(kSheetHead + "[[run]]\nname = \"heavy\"\nscene = \"pendulum\"\n" + kPanel +
                         "[[measure]]\ntext = \"x\"\npanel = \"hevy\"\n"),
            "sheet.toml:11:9: measure.panel: no panel or run 'hevy'; did you mean 'heavy'?");
}

TEST(FigureSheet, TellsAFaultOfASceneWhereItIsNamed) {
  EXPECT_EQ(sheetErrorOf(kSheetHead + "[[panel]]\nscene = \"pendulun\"\n"),
            "sheet.toml:4:9: panel.scene: no scene 'pendulun' in the library; did you mean "
            "'pendulum'?");
  EXPECT_EQ(sheetErrorOf(kSheetHead + kPanel + "set = [\"simulation.fps=0\"]\n"),
            "sheet.toml:5:9: panel.scene: --set simulation.fps=0: simulation.fps: expected an "
            "integer in [1, 1000000], got 0");
}

TEST(FigureSheet, RefusesFramesAfterTheEnd) {
  const std::string error = sheetErrorOf(kSheetHead + kPanel + "frames = [0, 100000]\n");
  EXPECT_TRUE(error.starts_with("sheet.toml:6:10: panel.frames: expected frames below ")) << error;
}

TEST(FigureSheet, RefusesUnknownMetricsAndMissingBodies) {
  const std::string measure = kSheetHead + kPanel + "[[measure]]\ntext = \"x\"\npanel = \"p\"\n";
  EXPECT_EQ(sheetErrorOf(measure + "metric = \"join_error\"\nat_most = 1\n"),
            "sheet.toml:9:10: measure.metric: unknown metric 'join_error'; did you mean "
            "'joint_error'?");
  EXPECT_EQ(sheetErrorOf(measure + "metric = \"height\"\nat_most = 1\n"),
            "sheet.toml:9:10: measure.metric: expected a 'body' as well: height is y of a body's "
            "centre of mass");
  EXPECT_EQ(sheetErrorOf(measure + "metric = \"overlap\"\n"),
            "sheet.toml:6:1: measure: expected 'at_most' or 'at_least'");
}

TEST(FigureSheet, RefusesTheSenseless) {
  EXPECT_EQ(sheetErrorOf(kSheetHead),
            "sheet.toml:1:1: expected at least one [[panel]] or [[plot]]");
  EXPECT_EQ(sheetErrorOf(kSheetHead + kPanel + "[[plot]]\n"),
            "sheet.toml:6:1: plot: expected at least one [[plot.curve]]");
  EXPECT_EQ(sheetErrorOf("title = \"t\"\n" + kPanel),
            "sheet.toml:1:1: expected a value for 'claim'");
  EXPECT_EQ(sheetErrorOf(kSheetHead + "columns = 1\n" + kPanel + "span = 2\n"),
            "sheet.toml:1:1: columns: expected at least 2, the span of a panel");
  EXPECT_EQ(sheetErrorOf(kSheetHead + "layout = \"ring\"\n" + kPanel),
            "sheet.toml:3:10: layout: expected one of 'strip', 'grid', 'side_by_side', "
            "'onion_skin', got 'ring'");
}

TEST(FigureSheet, IsFoundByNumberAndByName) {
  for (const char* word : {"3", "03", "figure03", "axle", "03_axle"}) {
    EXPECT_EQ(readFigureSheet(word).name, "figure03") << word;
  }
  EXPECT_THROW(readFigureSheet("axel"), InputError);
}

TEST(FigureSheets, AllThatAreShippedCanBeReadAndMeasureSomething) {
  const std::vector<std::string> paths = figureSheets();
  ASSERT_GE(paths.size(), 5u);
  for (const std::string& path : paths) {
    const FigureSheet sheet = readFigureSheet(path);
    EXPECT_GT(sheet.number, 0) << path;
    EXPECT_FALSE(sheet.measures.empty()) << path;
    EXPECT_FALSE(sheet.claim.empty()) << path;
  }
}

}  // namespace
}  // namespace scenes
