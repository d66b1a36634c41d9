// What the user gets for good and bad words on the command line.
#include "program.h"

namespace tests {
namespace {

class CommandLine : public Program {
 protected:
  void expectRefused(const std::string& arguments, const std::string& told) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.errors;
    EXPECT_NE(outcome.errors.find(told), std::string::npos) << arguments << "\n" << outcome.errors;
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << arguments;
  }
};

TEST_F(CommandLine, HelpAndVersionSucceedAndGoToStandardOutput) {
  for (const char* arguments : {"--help", "--version", "render --help", "golden check --help"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments;
    EXPECT_FALSE(outcome.output.empty()) << arguments;
  }
}

TEST_F(CommandLine, AnUnknownCommandIsToldTheNearestOne) {
  expectRefused("rendr drop.toml", "did you mean 'render'?");
}

TEST_F(CommandLine, AnUnknownSceneIsRefused) {
  expectRefused("render no_such_scene", "no_such_scene");
}

TEST_F(CommandLine, AnUnknownOptionIsRefused) {
  expectRefused("render drop.toml --vdeo", "render: no option '--vdeo'; did you mean '--video'?");
  expectRefused("study accurcy", "study: no command 'accurcy'; did you mean 'accuracy'?");
  expectRefused("list --zzz", "list: no option '--zzz'; its options are --help, --json");
}

// What bash offers after these words.
TEST_F(CommandLine, TheShellCompletesCommandsOptionsAndScenes) {
  writeText(folder / "dbd.bash", run("completion bash").output);
  const auto offers = [&](const std::string& words, int at) {
    writeText(folder / "ask.sh", ". ./dbd.bash\nCOMP_WORDS=(" + words +
                                     ")\nCOMP_CWORD=" + std::to_string(at) +
                                     "\n_dbd\nprintf '%s\\n' \"${COMPREPLY[@]}\" > answer\n");
    EXPECT_EQ(std::system(("cd '" + folder.string() + "' && bash ask.sh").c_str()), 0);
    return readBytes(folder / "answer");
  };
  EXPECT_EQ(offers("dbd sim", 1), "simulate\n");
  EXPECT_EQ(offers("dbd study acc", 2), "accuracy\n");
  EXPECT_EQ(offers("dbd render wrecking", 2), "wrecking_ball\n");
  EXPECT_EQ(offers("dbd render pyramid --vid", 3), "--video\n");
  EXPECT_EQ(offers("dbd study accuracy --coll", 3), "--collect\n");
  EXPECT_NE(run("completion fish").output.find("-n '__fish_seen_subcommand_from render' -l video"),
            std::string::npos);
  expectRefused("completion tcsh", "SHELL");
}

TEST_F(CommandLine, TheManualPageHasEveryCommandAndOption) {
  const std::string page = run("man").output;
  for (const char* part :
       {".TH DBD 1", ".SS dbd study accuracy\n", "\\-\\-video", ".SH EXIT STATUS"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
}

TEST_F(CommandLine, NoCommandIsRefused) { expectRefused("", "ubcommand"); }

TEST_F(CommandLine, OverridesAreCheckedByKeyAndType) {
  expectRefused("simulate drop.toml --set simulation.iteratons=3", "iterations");
  expectRefused("simulate drop.toml --set simulation.iterations=many", "iterations");
  expectRefused("simulate drop.toml --set simulation.fps=0", "fps");
  expectRefused("simulate drop.toml --set nonsense", "nonsense");
}

TEST_F(CommandLine, FramesSizesAndWordsAreChecked) {
  expectRefused("render drop.toml --frames 5:5", "--frames");
  expectRefused("render drop.toml --frames a:b", "--frames");
  expectRefused("render drop.toml --frames 0:5:0", "--frames");
  expectRefused("render drop.toml --frames 500", "--frames");
  expectRefused("render drop.toml --size 100", "--size");
  expectRefused("render drop.toml --size 0x100", "--size");
  expectRefused("render drop.toml --quality best", "--quality");
  expectRefused("render drop.toml --overlays shadows", "--overlays");
  expectRefused("render drop.toml --progress loud", "--progress");
  expectRefused("render drop.toml --threads 0", "--threads");
  expectRefused("render drop.toml --fresh --resume", "--");
}

TEST_F(CommandLine, ASceneThatIsNotTomlIsToldWithItsPlace) {
  writeText(folder / "bad.toml", "title = \n");
  expectRefused("check bad.toml", "bad.toml:1:");
}

TEST_F(CommandLine, CheckSucceedsWhereTheExpectationsHold) {
  const Outcome outcome = run("check drop.toml");
  EXPECT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  EXPECT_NE(outcome.output.find("overlap"), std::string::npos);
}

TEST_F(CommandLine, CheckFailsWithThreeWhereOneDoesNotHold) {
  const Outcome outcome = run("check drop.toml --set gravity.acceleration=[0,9.81,0] drop.toml");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;  // it floats away: no overlap at all
  std::string text = readBytes(folder / "drop.toml");
  writeText(folder / "bad.toml", text + "[[expect]]\nmetric = \"max_speed\"\nat_most = 0.5\n");
  const Outcome failed = run("check bad.toml drop.toml");
  EXPECT_EQ(failed.code, 3);
  EXPECT_NE(failed.output.find("FAIL"), std::string::npos) << failed.output;
}

TEST_F(CommandLine, CheckRefusesTwoScenesOfOneNameThatWouldWriteOneFolder) {
  std::filesystem::create_directory(folder / "other");
  writeText(folder / "other" / "drop.toml", readBytes(folder / "drop.toml"));
  EXPECT_EQ(run("check drop.toml other/drop.toml").code, 0);
  expectRefused("check drop.toml other/drop.toml --out verdicts",
                "'drop.toml' and 'other/drop.toml' both have the folder verdicts/drop;");
  EXPECT_FALSE(std::filesystem::exists(folder / "verdicts"));
}

TEST_F(CommandLine, ListNamesTheLibraryAsTextAndJson) {
  EXPECT_EQ(run("list").code, 0);
  const Outcome json = run("list --json");
  EXPECT_EQ(json.code, 0);
  EXPECT_EQ(json.output.front(), '[');
}

TEST_F(CommandLine, DoctorNamesEveryPart) {
  const Outcome outcome = run("doctor");
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 4);
  for (const char* part : {"renderer", "font", "ffmpeg", "gnuplot", "cpu", "Bullet", "ODE"}) {
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace tests
