// Words in single quotes where they need them.
#include "app/base/shell.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace app {

std::string shellQuoted(const std::string& word) {
  const bool isPlain = std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) ||
           std::string("._-/=,:+%@").find(static_cast<char>(c)) != std::string::npos;
  });
  if (isPlain && !word.empty()) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string programPath() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? "dbd" : program.string();
}

}  // namespace app
