// A film drawn job by job: on processes of one machine, and by Slurm where one answers.
#include <cstdlib>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

class Shards : public Program {
 protected:
  static constexpr const char* kFilm =
      "render drop.toml --quiet --quality draft --size 160x90 --hud --frames 1:20:2 -o 'a film' ";

  void SetUp() override {
    Program::SetUp();
    const Outcome printed = run(kFilm + std::string("--jobs 3"));
    ASSERT_EQ(printed.code, 0) << printed.errors;
    jobs = lines(printed.output);
    ASSERT_EQ(jobs.size(), 3u);
    EXPECT_FALSE(fs::exists(folder / "a film"));  // they are printed, no more
    writeText(folder / "jobs", printed.output);
  }
  int shell(const std::string& command) const {
    return std::system(("cd '" + folder.string() + "' && " + command).c_str());
  }
  Outcome collect() const { return run(kFilm + std::string("--collect")); }
  void expectTheFilmOfOneRun() const {
    std::string one = kFilm;
    one.replace(one.find("'a film'"), 8, "one");
    ASSERT_EQ(run(one).code, 0);
    EXPECT_EQ(folderBytes(folder / "a film" / "frames"), folderBytes(folder / "one" / "frames"));
    EXPECT_EQ(run(kFilm).code, 0);  // and there is nothing left to draw
  }

  std::vector<std::string> jobs;
};

constexpr const char* kTwoProcesses = "xargs -d '\\n' -P2 -I{} sh -c '{}' < jobs";

TEST_F(Shards, OfTwoProcessesMakeTheFilmOfOneRun) {
  ASSERT_EQ(shell(kTwoProcesses), 0);
  ASSERT_EQ(shell(kTwoProcesses), 0);  // again: nothing changes
  const Outcome collected = collect();
  ASSERT_EQ(collected.code, 0) << collected.errors;
  expectTheFilmOfOneRun();
}

TEST_F(Shards, ThatWereKilledAreNamedAndMadeAgain) {
  ASSERT_EQ(shell(kTwoProcesses), 0);
  const fs::path torn = folder / "a film" / "jobs" / "1-of-3" / "frames" / "00009.png";
  writeText(torn, readBytes(torn).substr(0, 100));
  fs::remove_all(folder / "a film" / "jobs" / "2-of-3");
  const Outcome collected = collect();
  EXPECT_EQ(collected.code, 3);
  EXPECT_NE(collected.errors.find("these make the rest:\n" + jobs[1] + "\n" + jobs[2] + "\n"),
            std::string::npos)
      << collected.errors;
  ASSERT_EQ(shell(jobs[1] + " && " + jobs[2]), 0);
  ASSERT_EQ(collect().code, 0);
  expectTheFilmOfOneRun();
}

TEST_F(Shards, OfAnotherRunAreRefused) {
  EXPECT_NE(collect().errors.find("no job has drawn"), std::string::npos);
  ASSERT_EQ(shell(jobs[0]), 0);
  const Outcome other =
      run("render drop.toml --quality draft --size 160x90 --set gravity.acceleration=[0,-1,0] "
          "-o 'a film' --collect");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.errors.find("--set"), std::string::npos) << other.errors;
  EXPECT_NE(other.errors.find("--hud"), std::string::npos) << other.errors;
}

// The line of the README. It waits for at most a minute.
TEST_F(Shards, OfASlurmArrayMakeTheFilmOfOneRun) {
  if (shell("sinfo -h > /dev/null 2>&1") != 0) GTEST_SKIP() << "no Slurm answers";
  ASSERT_EQ(shell("timeout 60 sbatch --wait --output=/dev/null --array=1-$(wc -l < jobs) "
                  "--wrap 'sh -c \"$(sed -n ${SLURM_ARRAY_TASK_ID}p jobs)\"' > /dev/null"),
            0);
  ASSERT_EQ(collect().code, 0);
  expectTheFilmOfOneRun();
}

}  // namespace
}  // namespace tests
