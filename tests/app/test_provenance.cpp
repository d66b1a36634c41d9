// A picture, a film and a record tell how they were made, and are made again from that.
#include <nlohmann/json.hpp>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

// What is told under a keyword, up to the next chunk's checksum.
std::string noteOf(const std::string& png, const std::string& keyword) {
  const std::string mark = "tEXt" + keyword + '\0';
  const std::size_t at = png.find(mark);
  if (at == std::string::npos || at < 4) return "";
  std::size_t length = 0;
  for (std::size_t k = at - 4; k < at; ++k) {
    length = 256 * length + static_cast<unsigned char>(png[k]);
  }
  return png.substr(at + mark.size(), length - keyword.size() - 1);
}

class Provenance : public Program {
 protected:
  static constexpr const char* kDraw =
      "render drop.toml --quiet --quality draft --size 160x90 --set 'body.ball.color=\"orange\"' ";
  auto frames(const std::string& run) const { return folderBytes(folder / run / "frames"); }
};

TEST_F(Provenance, APictureTellsItsCommandAndThatDrawsIt) {
  ASSERT_EQ(run(kDraw + std::string("--hud --print-width 8.6 --frames 0:9:4 -o a")).code, 0);
  const std::string bytes = readBytes(folder / "a" / "frames" / "00004.png");
  const std::string mark = std::string("tEXtCommand") + '\0' + "dbd ";
  const std::size_t from = bytes.find(mark) + mark.size();
  ASSERT_NE(bytes.find(mark), std::string::npos);
  const std::string command = bytes.substr(from, bytes.find("--frames 4", from) + 10 - from);
  EXPECT_EQ(command,
            "render drop.toml --set 'body.ball.color=\"orange\"' --quality draft --size 160x90 "
            "--print-width 8.6 --hud --frames 4");
  ASSERT_EQ(run(command + " --quiet -o b").code, 0);
  EXPECT_EQ(readBytes(folder / "b" / "frames" / "00004.png"), bytes);
  for (const std::string& told :
       {std::string("A ball falls"), std::string("Time\0000.0666667 s", 16), std::string("pHYs")}) {
    EXPECT_NE(bytes.find(told), std::string::npos) << told;
  }
}

TEST_F(Provenance, ARecordMakesTheSameFramesAgainWithoutTheScene) {
  ASSERT_EQ(run(kDraw + std::string("--overlays masses --frames 0:9:4 -o a")).code, 0);
  fs::remove(folder / "drop.toml");
  const Outcome again = run("render a/run.json --quiet -o b");
  ASSERT_EQ(again.code, 0) << again.errors;
  EXPECT_EQ(frames("a"), frames("b"));
  ASSERT_EQ(run("render a/run.json --quiet --set duration=0.1 --frames 4 -o c").code, 0);
  EXPECT_EQ(frames("c").size(), 1u);
  const auto record = nlohmann::json::parse(readBytes(folder / "b" / "run.json"));
  EXPECT_EQ(record.at("settings").at("method"), "small_steps");
  EXPECT_EQ(record.at("frames"), "0:9:4");
}

// The scene's file may say something else by now, or be gone.
TEST_F(Provenance, TheTrustOfARecordIsThatOfItsText) {
  const std::string small = " --quiet --quality draft --size 96x64 --frames 0 --set duration=0.1 ";
  ASSERT_EQ(run("render drop.toml --trust -o a" + small).code, 0);
  fs::remove(folder / "drop.toml");
  const Outcome again = run("render a/run.json --trust -o b" + small);
  ASSERT_EQ(again.code, 0) << again.errors;
  EXPECT_EQ(readBytes(folder / "a" / "difference.csv"), readBytes(folder / "b" / "difference.csv"));
  EXPECT_EQ(run("trust a/run.json --quiet --no-film -o c").code, 0);
}

TEST_F(Provenance, AFigureTellsItsCommandAndThatDrawsIt) {
  writeText(folder / "fall.toml", R"(title = "A fall"
claim = "Things fall."
[[panel]]
name = "fall"
scene = "./drop.toml"
frames = [0, 10]
)");
  ASSERT_EQ(run("figures fall.toml --quality draft --width 320 --quiet -o a").code, 0);
  const std::string figure = readBytes(folder / "a" / "fall.png");
  const std::string command = noteOf(figure, "Command");
  EXPECT_EQ(command, "dbd figures fall.toml --width 320 --quality draft");
  EXPECT_NE(figure.find("pHYs"), std::string::npos);
  ASSERT_EQ(run(command.substr(4) + " --quiet -o b").code, 0);
  EXPECT_EQ(readBytes(folder / "b" / "fall.png"), figure);
}

TEST_F(Provenance, ARecordOfASimulationIsASceneToo) {
  const std::string hash = run("simulate drop.toml --quiet --hash -o a").output;
  EXPECT_EQ(run("simulate a/run.json --quiet --hash -o b").output, hash);
}

TEST_F(Provenance, WhatIsNoRecordIsRefused) {
  writeText(folder / "empty.json", "{}");
  for (const auto& [file, told] :
       {std::pair{"none.json", "no such file"}, {"empty.json", "it is no run.json"}}) {
    const Outcome refused = run(std::string("render ") + file);
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.errors.find(told), std::string::npos) << refused.errors;
  }
}

TEST_F(Provenance, AFilmTellsItsTitleAndCommand) {
  if (std::system("ffprobe -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg here";
  ASSERT_EQ(run(kDraw + std::string("-o a --video")).code, 0);
  const std::string ask = "cd '" + folder.string() +
                          "' && ffprobe -v error -show_entries format_tags=title,comment -of "
                          "csv=p=0 a/drop.mp4 > tags.txt";
  ASSERT_EQ(std::system(ask.c_str()), 0);
  const std::string tags = readBytes(folder / "tags.txt");
  EXPECT_NE(tags.find("A ball falls"), std::string::npos) << tags;
  EXPECT_NE(tags.find("--frames 0:20 --video; scene drop.toml "), std::string::npos) << tags;
}

}  // namespace
}  // namespace tests
