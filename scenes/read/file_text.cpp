// What a file holds.
#include "scenes/read/file_text.h"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace scenes {

std::optional<std::string> fileText(const std::string& path) {
  std::error_code error;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path, error)) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return std::nullopt;
  return text.str();
}

}  // namespace scenes
