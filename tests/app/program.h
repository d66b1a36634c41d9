// Runs the built dbd as a user would, in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tests {

struct Outcome {
  int code = -1;  // 128 + the signal where one ended it
  std::string output, errors;
};

std::string readBytes(const std::filesystem::path& file);
void writeText(const std::filesystem::path& file, const std::string& text);
std::vector<std::string> lines(const std::string& text);
std::vector<std::string> cells(const std::string& row);

// File names of a folder and what is in them: equal when two folders hold the same bytes.
std::vector<std::pair<std::string, std::string>> folderBytes(const std::filesystem::path& folder);

// A fresh folder per test, with two scenes in it; the program runs there.
class Program : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  // The arguments go through a shell, so redirections work. `prefix` comes before the program.
  Outcome run(const std::string& arguments, const std::string& prefix = "") const;

  // Starts it, ends it with `signal` once `marker` exists, returns its exit code.
  int runAndSignal(const std::string& arguments, const std::filesystem::path& marker,
                   int signal) const;

  std::filesystem::path folder;  // holds drop.toml: a ball falls on the ground, 20 frames
};

}  // namespace tests
