// Which program this is.
#pragma once

#include <string>
#include <string_view>

namespace app {

std::string version();
std::string compiler();
std::string compileFlags();
std::string programHash();  // of the running program's bytes; 16 hex digits

std::string hashText(std::string_view bytes);  // 64-bit xxhash, 16 hex digits

}  // namespace app
