// One pass over the marks; what they do not enclose stays as it is.
#include "render/marked_text.h"

#include <algorithm>

namespace render {

namespace {

bool hasStar(const std::string& marked, std::size_t from) {
  for (std::size_t i = from; i < marked.size(); ++i) {
    if (marked[i] == '\\') {
      ++i;
    } else if (marked[i] == '*') {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<TextRun> textRuns(const std::string& marked) {
  std::vector<TextRun> runs;
  bool slanted = false;
  const auto add = [&](const std::string& words, int level) {
    if (words.empty()) return;
    if (!runs.empty() && runs.back().level == level && runs.back().slanted == slanted) {
      runs.back().words += words;
    } else {
      runs.push_back({words, level, slanted});
    }
  };
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const char c = marked[i], next = i + 1 < marked.size() ? marked[i + 1] : '\0';
    const std::size_t close = marked.find('}', i);
    if (c == '\\' && next == '*') {
      add("*", 0);
      ++i;
    } else if (c == '*' && (slanted || hasStar(marked, i + 1))) {
      slanted = !slanted;
    } else if ((c == '_' || c == '^') && next == '{' && close != std::string::npos) {
      add(marked.substr(i + 2, close - i - 2), c == '_' ? -1 : 1);
      i = close;
    } else {
      add(std::string(1, c), 0);
    }
  }
  return runs;
}

int letterCount(const std::string& marked) {
  int count = 0;
  for (const TextRun& run : textRuns(marked)) {
    count += static_cast<int>(std::count_if(run.words.begin(), run.words.end(),
                                            [](char c) { return (c & 0xC0) != 0x80; }));
  }
  return count;
}

}  // namespace render
