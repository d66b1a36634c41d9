// golden.json keeps the motion behind the pictures: a change late in it leaves the early pictures
// as they are, and is named with its frame and body.
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

// Two balls fall, one of them onto a step.
constexpr const char* kFlight = R"(title = "Balls fly"
duration = 0.5
[gravity]
acceleration = [0, -9.81, 0]
[[body]]
name = "far"
shape = { sphere = { radius = 0.1 } }
mass = 1
position = [1, 0.3, 0]
[[body]]
name = "near"
shape = { sphere = { radius = 0.1 } }
mass = 1
position = [0, 0.3, 0]
[[body]]
name = "step"
shape = { box = { size = [0.4, 0.1, 0.4] } }
fixed = true
position = [0, -0.35, 0]
[contact]
friction = 0.5
[camera]
direction = [0, -0.2, -1]
[golden]
frames = [0, 10, 30]
)";

class GoldenMotion : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    writeText(folder / "fly.toml", kFlight);
    ASSERT_EQ(golden("update --reason first").code, 0);
  }
  Outcome golden(const std::string& arguments) const {
    return run("golden " + arguments + " fly.toml --goldens goldens --progress none");
  }
  fs::path record() const { return folder / "goldens" / "fly" / "golden.json"; }
};

// A ball that bounces moves the bounds of the whole motion, and so a camera that fits them.
TEST_F(GoldenMotion, AChangeLateInTheMotionLeavesTheEarlyPictures) {
  const Outcome check = golden("check --strict --set contact.restitution=0.9");
  EXPECT_EQ(check.code, 3);
  const std::vector<std::string> told = lines(check.output);
  ASSERT_GE(told.size(), 3u) << check.output << check.errors;
  EXPECT_EQ(told[0], "ok    fly 00000                identical");
  EXPECT_EQ(told[1], "ok    fly 00010                identical");
  EXPECT_TRUE(told[2].starts_with("FAIL  fly 00030")) << told[2];
  EXPECT_NE(told[2].find("the physics moved first at frame "), std::string::npos) << told[2];
  EXPECT_NE(told[2].find("most of all body 'near', by "), std::string::npos) << told[2];
}

TEST_F(GoldenMotion, TheBodyIsNamedWithTheWayThatItIsOff) {
  const Outcome check = golden("check --set body.far.position=[1,0.303,0]");
  EXPECT_NE(check.output.find("first at frame 0; most of all body 'far', by 3 mm"),
            std::string::npos)
      << check.output;
}

TEST_F(GoldenMotion, OtherBodiesAreToldAsThat) {
  const Outcome check = golden("check --set body.far.name=away");
  EXPECT_EQ(check.code, 0) << check.output;  // the same picture
  const std::string more =
      "[[body]]\nname = \"more\"\nmass = 1\nshape = { sphere = { radius = 1 } }\n";
  writeText(folder / "fly.toml", kFlight + more);
  const Outcome another = golden("check");
  EXPECT_NE(another.output.find("the bodies are others or have other names, 4 and were 3"),
            std::string::npos)
      << another.output;
}

// As they were before they kept a motion.
TEST_F(GoldenMotion, ARecordWithoutIsStillGood) {
  const std::string text = readBytes(record());
  const std::size_t motion = text.find("\"motion\"");
  ASSERT_NE(motion, std::string::npos);
  writeText(record(), text.substr(0, text.rfind(',', motion)) + "}");
  EXPECT_EQ(golden("check --strict").code, 0);
  const Outcome moved = golden("check --set body.far.position=[1,0.35,0]");
  EXPECT_NE(moved.output.find("; the physics moved\n"), std::string::npos) << moved.output;
  ASSERT_EQ(golden("update --reason 'with its motion'").code, 0);
  EXPECT_NE(readBytes(record()).find("\"motion\""), std::string::npos);
}

}  // namespace
}  // namespace tests
