// Lists of words as text.
#pragma once

#include <string>
#include <string_view>

namespace scenes {

// "a, b, c"
template <class Words>
std::string joined(const Words& words, std::string_view between) {
  std::string text;
  std::string_view before;
  for (const auto& word : words) {
    text += before;
    text += word;
    before = between;
  }
  return text;
}

}  // namespace scenes
