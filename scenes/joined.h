// Lists of words and of whole numbers as text.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

namespace scenes {

// "a, b, c"
template <class Words>
std::string joined(const Words& words, std::string_view between) {
  std::string text;
  std::string_view before;
  for (const auto& word : words) {
    text += before;
    if constexpr (std::is_integral_v<std::decay_t<decltype(word)>>) {
      text += std::to_string(word);
    } else {
      text += word;
    }
    before = between;
  }
  return text;
}

}  // namespace scenes
