// `dbd golden` and `dbd compare` as gates: they pass what is the same, and fail, with a reason,
// what is not.
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

class Golden : public Program {
 protected:
  Outcome golden(const std::string& arguments) const {
    return run("golden " + arguments + " drop.toml --goldens goldens");
  }
};

TEST_F(Golden, UpdateNeedsAReason) {
  EXPECT_EQ(golden("update").code, 2);
  EXPECT_EQ(golden("update --reason ' '").code, 2);
  EXPECT_FALSE(fs::exists(folder / "goldens"));
}

TEST_F(Golden, TwoScenesOfOneNameAreRefused) {
  fs::create_directory(folder / "other");
  writeText(folder / "other" / "drop.toml", readBytes(folder / "drop.toml"));
  for (const std::string part : {"update --reason 'the first'", "check"}) {
    const Outcome both = golden(part + " other/drop.toml");
    EXPECT_EQ(both.code, 2);
    EXPECT_NE(both.errors.find("both have the folder goldens/drop;"), std::string::npos) << both.errors;
  }
  EXPECT_FALSE(fs::exists(folder / "goldens"));
}

TEST_F(Golden, UpdateSaysWhereThereIsNothingToApprove) {
  const std::string text = readBytes(folder / "drop.toml");
  writeText(folder / "drop.toml", text.substr(0, text.find("[golden]")));
  const Outcome update = golden("update --reason 'the first'");
  EXPECT_EQ(update.code, 3);
  EXPECT_NE(update.output.find("has no golden frames"), std::string::npos) << update.output;
  EXPECT_NE(update.errors.find("nothing was approved"), std::string::npos) << update.errors;
  EXPECT_FALSE(fs::exists(folder / "goldens"));
}

TEST_F(Golden, WhatWasApprovedPassesAndIsNotRewritten) {
  EXPECT_EQ(golden("check").code, 3);  // nothing approved yet
  const Outcome update = golden("update --reason 'the first'");
  ASSERT_EQ(update.code, 0) << update.errors;
  EXPECT_NE(update.output.find("new"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "goldens" / "drop" / "00006.png"));
  const Outcome check = golden("check --strict");
  EXPECT_EQ(check.code, 0) << check.output;
  const std::string record = readBytes(folder / "goldens" / "drop" / "golden.json");
  EXPECT_NE(golden("update --reason 'again'").output.find("unchanged"), std::string::npos);
  EXPECT_EQ(readBytes(folder / "goldens" / "drop" / "golden.json"), record);
}

TEST_F(Golden, AMovedBodyFailsAndThePhysicsIsNamed) {
  ASSERT_EQ(golden("update --reason 'the first'").code, 0);
  const Outcome moved = golden("check --set body.ball.velocity=[1.3,0,0]");
  EXPECT_EQ(moved.code, 3);
  EXPECT_NE(moved.output.find("the physics moved"), std::string::npos) << moved.output;
  const fs::path report = folder / "out" / "golden";
  EXPECT_TRUE(fs::exists(report / "index.html"));
  for (const char* part : {"want", "got", "difference"}) {
    EXPECT_TRUE(fs::exists(report / ("drop_00006-" + std::string(part) + ".png"))) << part;
  }
}

TEST_F(Golden, AMovedCameraFailsAndOnlyThePictureIsNamed) {
  ASSERT_EQ(golden("update --reason 'the first'").code, 0);
  const std::string moved = "--set camera.eye=[0,1,3.5]";
  const Outcome check = golden("check " + moved);
  EXPECT_EQ(check.code, 3) << check.errors;
  EXPECT_NE(check.output.find("only the picture moved"), std::string::npos) << check.output;
  EXPECT_NE(golden("update --reason nearer " + moved).output.find("only the picture moved"),
            std::string::npos);
  EXPECT_EQ(golden("check " + moved).code, 0);
}

TEST_F(Golden, ADamagedImageFailsAndTheOthersAreChecked) {
  ASSERT_EQ(golden("update --reason 'the first'").code, 0);
  const fs::path image = folder / "goldens" / "drop" / "00000.png";
  const std::string whole = readBytes(image);
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";
  for (const std::string& damaged : {std::string(), whole.substr(0, 100), pointer}) {
    writeText(image, damaged);
    const Outcome check = golden("check");
    EXPECT_EQ(check.code, 3) << check.errors;
    const std::vector<std::string> told = lines(check.output);
    ASSERT_GE(told.size(), 2u) << check.output;
    EXPECT_TRUE(told[0].starts_with("FAIL  drop 00000")) << told[0];
    EXPECT_NE(told[0].find(damaged == pointer ? "git lfs pull" : "not a readable PNG"),
              std::string::npos)
        << told[0];
    EXPECT_TRUE(told[1].starts_with("ok    drop 00006")) << told[1];
  }
  EXPECT_EQ(golden("update --reason 'it was damaged'").code, 0);
  EXPECT_EQ(readBytes(image), whole);
}

TEST_F(Golden, ABrokenRecordFails) {
  ASSERT_EQ(golden("update --reason 'the first'").code, 0);
  const fs::path record = folder / "goldens" / "drop" / "golden.json";
  const std::string whole = readBytes(record);
  for (const std::string& broken :
       {std::string(), whole.substr(0, 100), std::string("{}"), std::string("[1]"),
        std::string("{\"reason\": 1, \"frames\": []}"), std::string("<<<<<<< HEAD\n")}) {
    writeText(record, broken);
    const Outcome check = golden("check");
    EXPECT_EQ(check.code, 3) << broken << check.errors;
    EXPECT_NE(check.output.find("golden.json cannot be read"), std::string::npos) << check.output;
  }
}

TEST_F(Golden, NumbersThatEndFailAndTheOthersAreChecked) {
  std::string lost = readBytes(folder / "drop.toml");
  lost += "[[force]]\nbody = \"ball\"\nforce = [0, 1.7e308, 0]\n";
  writeText(folder / "lost.toml", lost);
  ASSERT_EQ(golden("update --reason 'the first'").code, 0);
  const Outcome check = run("golden check lost.toml drop.toml --goldens goldens");
  EXPECT_EQ(check.code, 3);
  EXPECT_NE(check.output.find("FAIL  lost 00006"), std::string::npos) << check.output;
  EXPECT_NE(check.output.find("ok    drop 00006"), std::string::npos) << check.output;
}

TEST_F(Golden, RepeatingTellsWhichImagesAreSteady) {
  ASSERT_EQ(golden("update --reason 'the first'").code, 0);
  const Outcome check = golden("check --repeat 3");
  EXPECT_EQ(check.code, 0) << check.errors;
  EXPECT_NE(check.output.find("drop 00006               identical; steady in 3 runs"),
            std::string::npos)
      << check.output;
  EXPECT_EQ(golden("check --repeat 0").code, 2);
}

// What somebody with scenes of their own has in continuous integration.
TEST_F(Golden, ARepositoryOfScenesOfItsOwnIsChecked) {
  fs::create_directories(folder / "scenes");
  fs::rename(folder / "drop.toml", folder / "scenes" / "drop.toml");
  const std::string more = " scenes/*.toml --goldens goldens --progress none";
  ASSERT_EQ(run("golden update --reason 'the first'" + more).code, 0);
  ASSERT_EQ(run("golden check --junit golden.xml" + more).code, 0);
  const std::string passed = readBytes(folder / "golden.xml");
  EXPECT_NE(passed.find("tests=\"2\" failures=\"0\""), std::string::npos) << passed;
  EXPECT_NE(passed.find("<testcase classname=\"drop\" name=\"00006\">"), std::string::npos);
  const Outcome moved =
      run("golden check --junit golden.xml --set body.ball.velocity=[1.3,0,0]" + more);
  EXPECT_EQ(moved.code, 3);
  EXPECT_NE(moved.output.find("FLIP mean"), std::string::npos) << moved.output;
  const std::string failed = readBytes(folder / "golden.xml");
  EXPECT_NE(failed.find("failures=\"1\""), std::string::npos) << failed;
  EXPECT_NE(failed.find("<failure message="), std::string::npos) << failed;
  EXPECT_TRUE(fs::exists(folder / "out" / "golden" / "index.html"));
}

TEST_F(Golden, CompareTellsEqualFromDifferentImagesAndFolders) {
  ASSERT_EQ(golden("update --reason 'the first'").code, 0);
  ASSERT_EQ(
      run("render drop.toml --quiet --quality standard --size 480x270 --frames 0:7:6 -o run").code,
      0);
  const std::string want = "goldens/drop/00006.png";
  EXPECT_EQ(run("compare --exact " + want + " " + want).code, 0);
  const Outcome different = run("compare " + want + " goldens/drop/00000.png -o report");
  EXPECT_EQ(different.code, 3);
  EXPECT_TRUE(fs::exists(folder / "report" / "index.html"));
  EXPECT_EQ(run("compare goldens/drop run/frames").code, 0);
  fs::remove(folder / "run" / "frames" / "00000.png");
  EXPECT_EQ(run("compare goldens/drop run/frames").code, 3);
  EXPECT_EQ(run("compare nothing " + want).code, 2);
  EXPECT_EQ(run("compare drop.toml " + want).code, 2);
  EXPECT_EQ(run("compare goldens " + want).code, 2);
}

TEST_F(Golden, GalleryShowsWhatWasRendered) {
  EXPECT_EQ(run("gallery out").code, 2);
  ASSERT_EQ(run("render drop.toml --quiet --quality draft --size 160x90").code, 0);
  const Outcome gallery = run("gallery out");
  EXPECT_EQ(gallery.code, 0);
  EXPECT_EQ(gallery.output, "out/index.html\n");
  const std::string page = readBytes(folder / "out" / "index.html");
  for (const char* part : {"A ball falls", "drop/frames/00010.png", "overlap", "holds"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
}

// As app/run.sh has it: the page of what is done so far, its parts linked at the top.
TEST_F(Golden, GalleryOfAWholeOutputLinksItsParts) {
  const std::string draw =
      "render drop.toml --quiet --quality draft --size 160x90 -o out/scenes/drop";
  ASSERT_EQ(run(draw).code, 0);
  ASSERT_EQ(run("gallery out").code, 0);
  const std::string first = readBytes(folder / "out" / "index.html");
  EXPECT_NE(first.find("scenes/drop/frames/00010.png"), std::string::npos);
  EXPECT_NE(first.find("<a href=\"#scenes\">Films</a>"), std::string::npos);
  EXPECT_EQ(first.find("href=\"#study\""), std::string::npos);
  fs::create_directories(folder / "out" / "study");
  writeText(folder / "out" / "study" / "index.html", "a study");
  ASSERT_EQ(run("gallery out").code, 0);
  const std::string more = readBytes(folder / "out" / "index.html");
  EXPECT_NE(more.find("href=\"#study\""), std::string::npos);
  EXPECT_LT(more.find("id=\"scenes\""), more.find("id=\"study\""));
}

}  // namespace
}  // namespace tests
