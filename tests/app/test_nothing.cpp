// A command that has nothing to do says so and fails: it must not pass for one that found all well.
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

class Nothing : public Program {
 protected:
  static void expectTold(const Outcome& outcome, int code, const std::string& told) {
    EXPECT_EQ(outcome.code, code) << outcome.output << outcome.errors;
    EXPECT_NE(outcome.errors.find(told), std::string::npos) << outcome.errors;
  }
  // drop.toml without the table that begins with this line, to its end.
  void writeWithout(const std::string& header) const {
    const std::string text = readBytes(folder / "drop.toml");
    const std::size_t begin = text.find(header);
    const std::size_t end = text.find("\n[", begin);
    writeText(folder / "bare.toml",
              text.substr(0, begin) + (end == std::string::npos ? "" : text.substr(end + 1)));
  }
};

TEST_F(Nothing, NoLibraryIsToldWithItsFolder) {
  fs::create_directories(folder / "empty" / "scenes" / "library");
  for (const std::string home : {"DBD_HOME=empty", "DBD_HOME=/no/such/folder"}) {
    for (const char* command :
         {"list", "list --json", "check --all", "golden check", "golden update --reason r",
          "simulate pyramid", "figures", "study accuracy", "study stability", "study options"}) {
      SCOPED_TRACE(home + " dbd " + command);
      const Outcome outcome = run(command, home);
      EXPECT_EQ(outcome.code, 2) << outcome.output;
      EXPECT_EQ(outcome.output, "");
    }
    expectTold(run("check --all", home), 2, "scenes/library; " + home.substr(0, 8) + " (");
  }
}

TEST_F(Nothing, ACheckOfNoExpectationFails) {
  writeWithout("[[expect]]");
  expectTold(run("check bare.toml --quiet"), 3, "nothing was checked");
  EXPECT_EQ(run("check bare.toml drop.toml --quiet").code, 0);
}

TEST_F(Nothing, AGoldenCheckOfNoFrameFails) {
  writeWithout("[golden]");
  expectTold(run("golden check bare.toml --goldens g"), 3, "nothing was compared");
}

TEST_F(Nothing, ASceneWithoutBodiesIsRefused) {
  for (const char* text : {"", "# nothing\n", "title = \"none\"\n[gravity]\n"}) {
    writeText(folder / "none.toml", text);
    for (const char* command : {"simulate", "render", "check", "plan"}) {
      expectTold(run(std::string(command) + " none.toml"), 2,
                 "none.toml: expected at least one [[body]]");
    }
  }
}

}  // namespace
}  // namespace tests
