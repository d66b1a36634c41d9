// The known word closest to a misspelt one.
#pragma once

#include <span>
#include <string>

namespace app {

// Empty when nothing is near enough to be a misspelling.
std::string nearestWord(const std::string& word, std::span<const std::string> known);

}  // namespace app
