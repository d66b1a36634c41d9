// Processes that work side by side: every task is done once, and no end of a worker is a hang.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <thread>

#include "app/commands/exit_code.h"
#include "app/run/crew.h"
#include "app/run/draw_apart.h"
#include "app/run/open_renderer.h"
#include "render/png.h"
#include "scenes/read/file_text.h"
#include "tests/render/sample.h"

namespace app {
namespace {

std::string echo(const std::string& task) { return task + " by " + std::to_string(::getpid()); }

TEST(Crew, DoesEveryTaskOnceInProcessesOfItsOwn) {
  std::map<int, std::string> answers;
  std::set<std::string> processes;
  Crew crew(3, echo, [&](int job, const std::string& answer) {
    EXPECT_TRUE(answers.emplace(job, answer.substr(0, answer.find(' '))).second);
    processes.insert(answer.substr(answer.rfind(' ') + 1));
  });
  for (int job = 0; job < 200; ++job) crew.ask(job, "task" + std::to_string(job));
  EXPECT_TRUE(crew.finish());
  ASSERT_EQ(answers.size(), 200u);
  for (const auto& [job, answer] : answers) EXPECT_EQ(answer, "task" + std::to_string(job));
  EXPECT_FALSE(processes.contains(std::to_string(::getpid())));
  EXPECT_GT(processes.size(), 1u);
}

TEST(Crew, TakesTasksThatAreLargerThanAPage) {
  std::string told;
  Crew crew(
      1, [](const std::string& task) { return task; },
      [&](int, const std::string& answer) { told = answer; });
  const std::string large(50000, 'x');
  crew.ask(0, large);
  EXPECT_TRUE(crew.finish());
  EXPECT_EQ(told, large);
}

// Several fail: the first by its number is told, whichever failed first.
TEST(Crew, ThrowsWhatTheFirstFailingJobThrew) {
  Crew crew(
      2,
      [](const std::string& task) -> std::string {
        const int job = std::stoi(task);
        if (job == 3) std::this_thread::sleep_for(std::chrono::milliseconds(200));
        if (job == 3) throw CheckFailed("job 3");
        if (job > 3) throw EnvironmentError("job " + task);
        return task;
      },
      [](int, const std::string&) {});
  for (int job = 0; job < 9; ++job) crew.ask(job, std::to_string(job));
  try {
    crew.finish();
    FAIL() << "nothing was thrown";
  } catch (const CheckFailed& error) {
    EXPECT_STREQ(error.what(), "job 3");
  }
}

TEST(Crew, ACrashIsAnErrorWithItsFrame) {
  for (const int signal : {SIGKILL, SIGSEGV}) {
    int answers = 0;
    Crew crew(
        2,
        [signal](const std::string& task) -> std::string {
          if (task == "5") {
            ::signal(signal, SIG_DFL);  // sanitizers have a handler
            ::raise(signal);
          }
          return task;
        },
        [&](int, const std::string&) { ++answers; });
    for (int job = 0; job < 40; ++job) crew.ask(job, std::to_string(job));
    try {
      crew.finish();
      FAIL() << "nothing was thrown";
    } catch (const EnvironmentError& error) {
      const std::string told = "drew frame 5 ended with signal " + std::to_string(signal);
      EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
    }
    EXPECT_GE(answers, 5);
  }
}

TEST(Crew, AbandoningDropsWhatNobodyHasBegun) {
  int answers = 0;
  Crew crew(2, echo, [&](int, const std::string&) { ++answers; });
  crew.pump();
  EXPECT_EQ(answers, 0);
  EXPECT_TRUE(crew.finish());
  crew.abandon();
}

class DrawApart : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(int frame) const { return (folder_ / std::to_string(frame)).string(); }
  void draw(int frame) {
    if (!renderer_) renderer_ = openRenderer({64, 36, render::Quality::kDraft, ""});
    render::writePng(drawFrame(*renderer_, frame, {&picture_, 1}), file(frame));
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("draw_apart_" + std::to_string(::getpid()));
  render::Picture picture_ = render::samplePicture();
  std::unique_ptr<render::Renderer> renderer_;
};

TEST_F(DrawApart, EveryFrameOnceAndTheSameInAnyProcess) {
  std::vector<int> frames(24);
  std::iota(frames.begin(), frames.end(), 0);
  int done = 0;
  EXPECT_TRUE(drawApart(
      frames, 3, [&](int frame) { draw(frame); }, [&] { ++done; }));
  EXPECT_EQ(done, 24);
  EXPECT_EQ(renderer_, nullptr) << "it was drawn here";
  draw(99);
  const auto bytes = scenes::fileText(file(99));
  ASSERT_TRUE(bytes);
  for (const int frame : frames) EXPECT_EQ(scenes::fileText(file(frame)), bytes) << frame;
}

TEST_F(DrawApart, NamesAFrameThatCannotBeDrawn) {
  picture_.instances[0].position.x() = std::numeric_limits<float>::infinity();
  try {
    drawApart({3}, 2, [&](int frame) { draw(frame); });
    FAIL() << "it was drawn";
  } catch (const CheckFailed& error) {
    EXPECT_EQ(std::string(error.what()).rfind("frame 3 cannot be drawn: ", 0), 0u) << error.what();
  }
}

TEST_F(DrawApart, TellsWhatAProcessThrewAndBeginsNothingMore) {
  std::vector<int> frames(100);
  std::iota(frames.begin(), frames.end(), 0);
  EXPECT_THROW(drawApart(frames, 2,
                         [&](int frame) {
                           if (frame == 5) throw EnvironmentError("no space");
                           std::ofstream(file(frame)) << frame;
                         }),
               EnvironmentError);
  EXPECT_TRUE(std::filesystem::exists(file(4)));
  EXPECT_FALSE(std::filesystem::exists(file(50)));
}

}  // namespace
}  // namespace app
