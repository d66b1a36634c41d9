// Text with sub- and superscripts and slanted letters, as labels and axis titles use it.
#pragma once

#include <string>
#include <vector>

namespace render {

struct TextRun {
  std::string words;
  int level = 0;  // -1 lowered, 1 raised
  bool slanted = false;
  bool operator==(const TextRun&) const = default;
};

// "*p*_{i}" is a slanted p and a lowered i. A star without a partner, and braces that do not close,
// are what they are; "\*" is a star.
std::vector<TextRun> textRuns(const std::string& marked);

// The letters alone: how many a reader sees.
int letterCount(const std::string& marked);

}  // namespace render
