// dbd figures as a user meets it: pictures, data and a page; nothing twice; nothing half.
#include <signal.h>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSheet = R"(title = "A fall"
claim = "Things fall."
layout = "strip"
[[panel]]
name = "fall"
scene = "./drop.toml"
frames = [0, 10]
[[plot]]
[[plot.curve]]
panel = "fall"
metric = "max_speed"
[[measure]]
text = "It hits the ground"
panel = "fall"
metric = "contacts"
over = "max"
at_least = 1
)";

class Figures : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    writeText(folder / "fall.toml", kSheet);
  }
  static constexpr const char* kMake = "figures fall.toml --quality draft --width 400 --quiet ";
};

TEST_F(Figures, MakesPictureDataRecordAndPage) {
  const Outcome outcome = run("figures fall.toml --quality draft --width 400 --progress none");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("It hits the ground"), std::string::npos);
  EXPECT_NE(outcome.output.find("out/index.html"), std::string::npos);
  EXPECT_EQ(readBytes(folder / "out" / "fall.png").substr(1, 3), "PNG");
  EXPECT_TRUE(readBytes(folder / "out" / "fall.csv").starts_with("run,scene,frame,time,metric,"));
  const std::string page = readBytes(folder / "out" / "index.html");
  for (const char* part : {"A fall", "Things fall.", "fall.png", "It hits the ground", "Holds",
                           "dbd figures fall.toml --fresh"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
}

TEST_F(Figures, FilmsHaveACameraOfTheirOwn) {
  const auto make = [&](const std::string& eye) {
    std::string sheet = "video = true\n" + std::string(kSheet);
    sheet.insert(sheet.find("frames ="),
                 "film_camera = { eye = " + eye + ", target = [0, 1, 0] }\n");
    writeText(folder / "fall.toml", sheet);
    const Outcome outcome = run(kMake);
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    return std::pair(readBytes(folder / "out" / "fall.png"),
                     readBytes(folder / "out" / "fall" / "frames" / "00000.png"));
  };
  // Beside its pixels a picture tells which sheet made it.
  const auto pixels = [](const std::string& png) { return png.substr(png.find("IDAT")); };
  const auto [still, frame] = make("[0, 1, 5]");
  const auto [stillAgain, farther] = make("[0, 1, 9]");
  EXPECT_TRUE(pixels(stillAgain) == pixels(still));
  EXPECT_FALSE(pixels(farther) == pixels(frame));
}

TEST_F(Figures, AreVectorsWhereThatIsAskedFor) {
  ASSERT_EQ(run(kMake).code, 0);
  ASSERT_EQ(run(kMake + std::string("--format pdf,svg")).code, 0) << "later, too";
  const std::string pdf = readBytes(folder / "out" / "fall.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF"));
  EXPECT_NE(pdf.find("/MediaBox [ 0 0 493.2"), std::string::npos) << "174 mm";
  EXPECT_NE(pdf.find("DejaVuSans"), std::string::npos);
  EXPECT_NE(pdf.find("/FontFile2"), std::string::npos);
  EXPECT_NE(pdf.find("/Subtype /Image"), std::string::npos);
  EXPECT_EQ(pdf.find("CreationDate"), std::string::npos);
  const std::string svg = readBytes(folder / "out" / "fall.svg");
  EXPECT_NE(svg.find("<image"), std::string::npos);
  EXPECT_NE(svg.find("<path"), std::string::npos);
  ASSERT_EQ(run(kMake + std::string("--format pdf,svg --fresh --threads 2")).code, 0);
  EXPECT_EQ(pdf, readBytes(folder / "out" / "fall.pdf"));
  EXPECT_EQ(svg, readBytes(folder / "out" / "fall.svg"));
  const Outcome wrong = run(kMake + std::string("--format eps"));
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.errors.find("eps"), std::string::npos) << wrong.errors;
}

TEST_F(Figures, WhatHasNotChangedIsNotMadeAgain) {
  ASSERT_EQ(run(kMake).code, 0);
  writeText(folder / "out" / "fall.png", "kept as it is");
  ASSERT_EQ(run(kMake).code, 0);
  EXPECT_EQ(readBytes(folder / "out" / "fall.png"), "kept as it is");
  ASSERT_EQ(run(kMake + std::string("--fresh")).code, 0);
  EXPECT_NE(readBytes(folder / "out" / "fall.png"), "kept as it is");
}

TEST_F(Figures, AChangedSheetSceneOrSizeIsMadeAgain) {
  ASSERT_EQ(run(kMake).code, 0);
  const auto isMadeAgain = [&](const std::string& arguments) {
    writeText(folder / "out" / "fall.png", "kept");
    EXPECT_EQ(run(arguments).code, 0);
    return readBytes(folder / "out" / "fall.png") != "kept";
  };
  writeText(folder / "fall.toml", std::string(kSheet) + "# changed\n");
  EXPECT_TRUE(isMadeAgain(kMake));
  writeText(folder / "drop.toml", readBytes(folder / "drop.toml") + "# changed\n");
  EXPECT_TRUE(isMadeAgain(kMake));
  EXPECT_TRUE(isMadeAgain("figures fall.toml --quality draft --width 420 --quiet"));
  EXPECT_FALSE(isMadeAgain("figures fall.toml --quality draft --width 420 --quiet"));
}

TEST_F(Figures, TheSameBytesForAnyThreads) {
  ASSERT_EQ(run(kMake + std::string("-o one --threads 1")).code, 0);
  ASSERT_EQ(run(kMake + std::string("-o two --threads 2")).code, 0);
  EXPECT_EQ(readBytes(folder / "one" / "fall.png"), readBytes(folder / "two" / "fall.png"));
}

TEST_F(Figures, AMeasureThatDoesNotHoldIsExitCodeThreeNowAndLater) {
  writeText(folder / "fall.toml", std::string(kSheet) + "at_most = 0.5\n");
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome = run("figures fall.toml --quality draft --width 400 --progress none");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_NE(outcome.output.find("FAIL"), std::string::npos);
  }
  const std::string page = readBytes(folder / "out" / "index.html");
  EXPECT_NE(page.find("Does not hold"), std::string::npos);
}

TEST_F(Figures, AKilledRunLeavesNothingThatLooksWhole) {
  writeText(folder / "fall.toml", "video = true\n" + std::string(kSheet));
  const fs::path marker = folder / "out" / "fall" / "frames" / "00002.png";
  EXPECT_EQ(runAndSignal(kMake, marker, SIGKILL), 128 + SIGKILL);
  EXPECT_FALSE(fs::exists(folder / "out" / "fall.json"));
  EXPECT_FALSE(fs::exists(folder / "out" / "fall.mp4"));
  ASSERT_EQ(run(kMake).code, 0);
  EXPECT_TRUE(fs::exists(folder / "out" / "fall.json"));
  for (const auto& [name, bytes] : folderBytes(folder / "out" / "fall" / "frames")) {
    EXPECT_FALSE(name.ends_with(".part")) << name;
  }
}

TEST_F(Figures, FaultsAreToldBeforeAnythingIsMade) {
  writeText(folder / "wrong.toml", std::string(kSheet) + "colour = 1\n");
  const Outcome outcome = run("figures fall.toml wrong.toml --quality draft --width 400");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("wrong.toml:18:1: measure: unknown key 'colour'"),
            std::string::npos)
      << outcome.errors;
  EXPECT_FALSE(fs::exists(folder / "out" / "fall.png"));
  EXPECT_EQ(run("figures 77").code, 2);
  EXPECT_EQ(run("figures fall.toml --quality best").code, 2);
}

TEST_F(Figures, AreListed) {
  const Outcome outcome = run("list");
  EXPECT_NE(outcome.output.find("figure03"), std::string::npos);
}

}  // namespace
}  // namespace tests
