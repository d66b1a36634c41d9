// 500 scenes and 500 models with mistakes from a fixed seed: each is run or refused at its place,
// in a process that may take five seconds and 256 MB. DBD_MUTATIONS=100000 tries more.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "scenes/scene.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/try_scene.h"

namespace tests {
namespace {

constexpr const char *kPath = "mutated.toml", *kModelPath = "mutated.xml";
constexpr int kGroups = 10;
constexpr rlim_t kMegabyte = 1 << 20;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__clang__)
constexpr bool kIsSanitized = true;  // or may be: slower, and with memory of its own
#else
constexpr bool kIsSanitized = false;
#endif

std::string textOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

const std::vector<std::string>& models() {
  static const std::vector<std::string> texts = {textOf(DBD_TEST_FOLDER "/models/creature.xml"),
                                                 textOf(DBD_TEST_FOLDER "/models/hills.xml"),
                                                 textOf(DBD_TEST_FOLDER "/models/crane.urdf")};
  return texts;
}

const std::vector<std::string>& library() {
  static const std::vector<std::string> texts = [] {
    std::vector<std::string> all;
    for (const std::string& name : scenes::libraryScenes()) {
      all.push_back(textOf(scenes::libraryFolder() + "/" + name + ".toml"));
    }
    return all;
  }();
  return texts;
}

void limit(int resource, rlim_t most) {
  const rlimit both{most, most};
  setrlimit(resource, &both);
}

[[noreturn]] void tryAsChild(const std::string& text, const char* path, int pipe) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU,
        kIsSanitized ? 30 : 5);  // against hanging: a step of 64 substeps takes most of one
  if (!kIsSanitized) limit(RLIMIT_DATA, 256 * kMegabyte);
  Tried tried{app::ExitCode::kBug, ""};
  try {
    tried = tryScene(text, path);
  } catch (const std::exception& error) {
    tried.told = error.what();
  }
  const bool written =
      write(pipe, tried.told.data(), tried.told.size()) == static_cast<ssize_t>(tried.told.size());
  _exit(written ? static_cast<int>(tried.code) : 99);
}

struct Ended {
  int code = -1;
  std::string told;
};

Ended tryInChild(const std::string& text, const char* path = kPath) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) tryAsChild(text, path, ends[1]);
  close(ends[1]);
  Ended ended;
  char buffer[4096];
  for (ssize_t got = 0; (got = read(ends[0], buffer, sizeof buffer)) > 0;) {
    ended.told.append(buffer, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ended;
}

void expectJudged(const std::string& text, int seed, const char* path = kPath) {
  const Ended ended = tryInChild(text, path);
  const bool documented = ended.code == 0 || ended.code == 2 || ended.code == 3;
  EXPECT_TRUE(documented) << "seed " << seed << ": exit code " << ended.code << " " << ended.told;
  if (ended.code != 2) return;
  const bool inAsset = ended.told.find("assets/") != std::string::npos;
  EXPECT_TRUE(inAsset || hasPlace(ended.told, path)) << "seed " << seed << ": " << ended.told;
}

int seedsInAll() {
  const char* asked = std::getenv("DBD_MUTATIONS");
  return asked != nullptr ? std::atoi(asked) : 500;
}

class Mutated : public testing::TestWithParam<int> {};

TEST_P(Mutated, ScenesAreRunOrRefusedAtTheirPlace) {
  for (int seed = GetParam(); seed < seedsInAll(); seed += kGroups) {
    expectJudged(mutated(library(), seed), seed);
    if (testing::Test::HasFailure() && seedsInAll() <= 500) {
      std::ofstream(testing::TempDir() + "mutated_" + std::to_string(seed) + ".toml")
          << mutated(library(), seed);
    }
  }
}

TEST_P(Mutated, ModelsAreRunOrRefusedAtTheirPlace) {
  for (int seed = GetParam(); seed < seedsInAll(); seed += kGroups) {
    expectJudged(mutated(models(), seed), seed, kModelPath);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Mutated, testing::Range(0, kGroups));

TEST(MutatedScenes, AreOfManyKinds) {
  int run = 0, refused = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const int code = tryInChild(mutated(library(), seed)).code;
    run += code == 0;
    refused += code == 2;
  }
  EXPECT_GT(run, 5);
  EXPECT_GT(refused, 20);
}

TEST(MutatedScenes, AProcessBeyondItsLimitsIsSeen) {
  if (kIsSanitized) GTEST_SKIP() << "its memory is not limited";
  const pid_t child = fork();
  if (child == 0) {
    limit(RLIMIT_DATA, 256 * kMegabyte);
    try {
      const std::vector<char> large(300 * kMegabyte, 1);
      _exit(large.back());
    } catch (const std::bad_alloc&) {
      _exit(42);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 42);
}

}  // namespace
}  // namespace tests
