// 500 scenes and 500 models with mistakes from a fixed seed: each is run or refused at its place,
// in a process that may take five seconds for it and 256 MB. DBD_MUTATIONS=100000 tries more.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>
#include <span>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "scenes/scene.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/try_scene.h"

namespace tests {
namespace {

constexpr const char *kPath = "mutated.toml", *kModelPath = "mutated.xml";
constexpr int kGroups = 10;
constexpr rlim_t kMegabyte = 1 << 20;

// Then it is slower, and has memory of its own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
constexpr bool kIsSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
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

void limit(int resource, rlim_t soft, rlim_t hard) {
  const rlimit both{soft, hard};
  setrlimit(resource, &both);
}

// Against hanging, from now on: a step of 64 substeps takes most of a second.
void limitTime() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec + 1);
  limit(RLIMIT_CPU, seconds + (kIsSanitized ? 30 : 5), RLIM_INFINITY);
}

struct Ended {
  int code = -1;
  std::string told;
};

Ended tryHere(const std::string& text, const char* path) {
  limitTime();
  try {
    Tried tried = tryScene(text, path);
    return {static_cast<int>(tried.code), std::move(tried.told)};
  } catch (const std::exception& error) {
    return {static_cast<int>(app::ExitCode::kBug), error.what()};
  }
}

int seedsInAll() {
  const char* asked = std::getenv("DBD_MUTATIONS");
  return asked != nullptr ? std::atoi(asked) : 500;
}

std::vector<int> groupOf(int first) {
  std::vector<int> seeds;
  for (int seed = first; seed < seedsInAll(); seed += kGroups) seeds.push_back(seed);
  return seeds;
}

using TextOf = std::function<std::string(int seed)>;

// As lines of code, length and text.
[[noreturn]] void tryAsChild(std::span<const int> seeds, const TextOf& text, const char* path,
                             int pipe) {
  limit(RLIMIT_CORE, 0, 0);
  if (!kIsSanitized) limit(RLIMIT_DATA, 256 * kMegabyte, 256 * kMegabyte);
  for (const int seed : seeds) {
    const Ended ended = tryHere(text(seed), path);
    const std::string line =
        std::to_string(ended.code) + " " + std::to_string(ended.told.size()) + "\n" + ended.told;
    if (write(pipe, line.data(), line.size()) != static_cast<ssize_t>(line.size())) _exit(99);
  }
  _exit(0);
}

std::vector<Ended> endsIn(const std::string& told) {
  std::vector<Ended> all;
  std::istringstream lines(told);
  for (std::size_t size = 0; lines >> (all.emplace_back().code) >> size;) {
    all.back().told.resize(size);
    lines.ignore();
    lines.read(all.back().told.data(), static_cast<std::streamsize>(size));
  }
  all.pop_back();
  return all;
}

// One after the other in one process; the last end is that of the one that ended it, if one did.
std::vector<Ended> tryInChild(std::span<const int> seeds, const TextOf& text, const char* path) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category());
  const pid_t child = fork();
  if (child == 0) tryAsChild(seeds, text, path, ends[1]);
  close(ends[1]);
  std::string told;
  char buffer[4096];
  for (ssize_t got = 0; (got = read(ends[0], buffer, sizeof buffer)) > 0;) {
    told.append(buffer, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  std::vector<Ended> all = endsIn(told);
  if (WIFSIGNALED(status)) all.push_back({128 + WTERMSIG(status), "a signal"});
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0) all.push_back({WEXITSTATUS(status), ""});
  return all;
}

// Starting a process costs more than most seeds do: it goes on until one ends it.
std::vector<Ended> tryAll(std::span<const int> seeds, const TextOf& text,
                          const char* path = kPath) {
  std::vector<Ended> all;
  while (all.size() < seeds.size()) {
    const std::vector<Ended> some = tryInChild(seeds.subspan(all.size()), text, path);
    if (some.empty()) throw std::runtime_error("a process told nothing");
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

void expectJudged(const std::vector<int>& seeds, const TextOf& text, const char* path) {
  const std::vector<Ended> all = tryAll(seeds, text, path);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Ended& ended = all[i];
    const bool documented = ended.code == 0 || ended.code == 2 || ended.code == 3;
    const bool inAsset = ended.told.find("assets/") != std::string::npos;
    const bool isPlaced = ended.code != 2 || inAsset || hasPlace(ended.told, path);
    EXPECT_TRUE(documented && isPlaced)
        << "seed " << seeds[i] << ": exit code " << ended.code << " " << ended.told;
    if (documented && isPlaced) continue;
    std::ofstream(testing::TempDir() + "mutated_" + std::to_string(seeds[i]) + "_" + path)
        << text(seeds[i]);
  }
}

std::string mutatedScene(int seed) { return mutated(library(), seed); }
std::string mutatedModel(int seed) { return mutated(models(), seed); }

class Mutated : public testing::TestWithParam<int> {};

TEST_P(Mutated, ScenesAreRunOrRefusedAtTheirPlace) {
  expectJudged(groupOf(GetParam()), mutatedScene, kPath);
}

TEST_P(Mutated, ModelsAreRunOrRefusedAtTheirPlace) {
  expectJudged(groupOf(GetParam()), mutatedModel, kModelPath);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Mutated, testing::Range(0, kGroups));

TEST(MutatedScenes, AreOfManyKinds) {
  int run = 0, refused = 0;
  std::vector<int> seeds(60);
  std::iota(seeds.begin(), seeds.end(), 0);
  for (const Ended& ended : tryAll(seeds, mutatedScene)) {
    run += ended.code == 0;
    refused += ended.code == 2;
  }
  EXPECT_GT(run, 5);
  EXPECT_GT(refused, 20);
}

TEST(MutatedScenes, OneThatEndsItsProcessIsToldAndTheOthersAreTried) {
  const std::vector<int> seeds = {0, 1, 2, 3};
  const std::vector<Ended> all = tryAll(seeds, [](int seed) {
    if (seed == 2) _exit(41);
    if (seed == 3) ::kill(::getpid(), SIGKILL);
    return mutatedScene(seed);
  });
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].code, tryAll(std::span(seeds).first(1), mutatedScene)[0].code);
  EXPECT_EQ(all[2].code, 41);
  EXPECT_EQ(all[3].code, 128 + SIGKILL);
}

TEST(MutatedScenes, AProcessBeyondItsLimitsIsSeen) {
  if (kIsSanitized) GTEST_SKIP() << "its memory is not limited";
  const pid_t child = fork();
  if (child == 0) {
    limit(RLIMIT_DATA, 256 * kMegabyte, 256 * kMegabyte);
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
