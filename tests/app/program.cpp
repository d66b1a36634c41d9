// Runs the built dbd as a user would, in a folder of its own.
#include "program.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

namespace tests {

namespace fs = std::filesystem;

namespace {

constexpr const char* kDrop = R"(title = "A ball falls"
duration = 0.316666667
[simulation]
fps = 60
[gravity]
acceleration = [0, -9.81, 0]
[contact]
friction = 0.5
[[body]]
name = "ground"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
fixed = true
[[body]]
name = "ball"
shape = { sphere = { radius = 0.25 } }
mass = 2
position = [0, 0.6, 0]
velocity = [1, 0, 0]
[camera]
eye = [0, 1, 4]
target = [0, 0.5, 0]
[golden]
frames = [0, 6]
[[expect]]
metric = "overlap"
at_most = 0.01
)";

int exitCode(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

std::string readBytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeText(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

std::vector<std::string> cells(const std::string& row) {
  std::vector<std::string> result;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');) result.push_back(cell);
  return result;
}

std::vector<std::pair<std::string, std::string>> folderBytes(const fs::path& folder) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    files.emplace_back(entry.path().filename().string(), readBytes(entry.path()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

void Program::SetUp() {
  std::string name = (fs::temp_directory_path() / "dbd-test-XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  folder = name;
  writeText(folder / "drop.toml", kDrop);
}

void Program::TearDown() { fs::remove_all(folder); }

Outcome Program::run(const std::string& arguments, const std::string& prefix) const {
  const fs::path output = folder / ".stdout", errors = folder / ".stderr";
  const std::string command = "cd '" + folder.string() + "' && { " + prefix +
                              " '" DBD_PROGRAM "' " + arguments + " ; } >'" + output.string() +
                              "' 2>'" + errors.string() + "' </dev/null";
  const int status = std::system(command.c_str());
  return {exitCode(status), readBytes(output), readBytes(errors)};
}

int Program::runAndSignal(const std::string& arguments, const fs::path& marker, int signal) const {
  const pid_t child = fork();
  if (child == 0) {
    const std::string command =
        "cd '" + folder.string() + "' && exec '" DBD_PROGRAM "' " + arguments + " >/dev/null 2>&1";
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (fs::exists(marker)) {
      kill(child, signal);
      waitpid(child, &status, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return exitCode(status);
}

}  // namespace tests
