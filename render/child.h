// A program run without a shell, with its input fed and its output kept.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace render {

struct ChildResult {
  bool started = false;  // false: no such program
  int exitCode = -1;     // 128 + the signal when one ended it
  std::string output, errors;
  bool inputTaken = true;  // false: it closed its input early
};

// Gives the child more input; false when the child takes no more.
using Feed = std::function<bool(const char* data, std::size_t size)>;

// Runs arguments[0] from PATH, lets `write` feed its standard input, waits, and returns what it
// printed. Throws std::system_error when the system gives no process or pipe.
ChildResult runChild(const std::vector<std::string>& arguments,
                     const std::function<void(const Feed&)>& write = {});

}  // namespace render
