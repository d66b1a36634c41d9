// What a scene starts with that its author can hardly have meant is told once, and kept.
#include "program.h"

namespace tests {
namespace {

class StartWarnings : public Program {};

constexpr const char* kWarning =
    "drop: at the start bodies 'ball' and 'ground' overlap by 0.15 m, 30 % of how thick the "
    "thinner one is";

TEST_F(StartWarnings, ADeepOverlapIsToldOnceAndInTheRecord) {
  for (const char* command :
       {"simulate drop.toml --quiet -o run", "check drop.toml --quiet -o .",
        "render drop.toml --quiet --quality draft --size 160x90 --frames 0:2 -o run --fresh"}) {
    const Outcome outcome = run(command + std::string(" --set body.ball.position=[0,0.1,0]"));
    const std::size_t first = outcome.errors.find(kWarning);
    EXPECT_NE(first, std::string::npos) << command << ": " << outcome.errors;
    EXPECT_EQ(outcome.errors.find("overlap by", first + 60), std::string::npos) << outcome.errors;
    const bool isCheck = std::string(command).starts_with("check");
    const std::string record = readBytes(folder / (isCheck ? "drop" : "run") / "run.json");
    EXPECT_NE(record.find("overlap by 0.15 m"), std::string::npos) << command;
  }
}

TEST_F(StartWarnings, BodiesThatTouchOrOverlapByRoundingAreNoMatter) {
  for (const char* height : {"0.25", "0.249"}) {
    const std::string lower = std::string(" --set body.ball.position=[0,") + height + ",0]";
    EXPECT_EQ(run("simulate drop.toml --quiet -o run" + lower).errors, "");
  }
}

}  // namespace
}  // namespace tests
