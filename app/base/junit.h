// Results as JUnit's XML, which continuous integration reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace app {

struct JunitCase {
  std::string suite, name;  // "pyramid", "frame 00030"
  std::string failure;      // empty: passed
  std::string output;       // for information
};

// `file` empty: nothing.
void writeJunit(const std::string& file, const std::string& title,
                const std::vector<JunitCase>& cases);

}  // namespace app
