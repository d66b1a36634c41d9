// What a file holds.
#pragma once

#include <optional>
#include <string>

namespace scenes {

// All its bytes; nothing where it is a folder or cannot be read.
std::optional<std::string> fileText(const std::string& path);

}  // namespace scenes
