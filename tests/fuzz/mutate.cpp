// Mutations of scene files and of models.
#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>

#include "physics/make/matter.h"

namespace tests {
namespace {

class Dice {
 public:
  explicit Dice(int seed) : random_(static_cast<std::uint64_t>(seed)) {}
  std::size_t below(std::size_t count) {
    return std::min(static_cast<std::size_t>(random_.uniform(0, 1) * static_cast<double>(count)),
                    count - 1);
  }
  template <std::size_t N>
  const char* oneOf(const char* const (&choices)[N]) {
    return choices[below(N)];
  }

 private:
  physics::Random random_;
};

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  if (lines.empty()) lines.emplace_back();
  return lines;
}

std::string joined(const std::vector<std::string>& lines, const char* end = "\n") {
  std::string text;
  for (const std::string& line : lines) text += line + end;
  return text;
}

std::string repeated(const std::string& piece, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += piece;
  return text;
}

struct Span {
  std::size_t first, length;
};

// Numbers that stand for themselves, not digits of a name.
std::vector<Span> numbersOf(const std::string& text) {
  const auto isPart = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  std::vector<Span> spans;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (!std::isdigit(static_cast<unsigned char>(text[i])) || isPart(text[i - 1])) continue;
    std::size_t end = i;
    while (end < text.size() && (isPart(text[end]) || text[end] == '.' || text[end] == '-')) ++end;
    const std::size_t first = text[i - 1] == '-' ? i - 1 : i;
    spans.push_back({first, end - first});
    i = end;
  }
  return spans;
}

std::string flipByte(std::string text, Dice& dice) {
  if (text.empty()) return text;
  char& byte = text[dice.below(text.size())];
  byte = static_cast<char>(byte ^ (1 << dice.below(8)));
  return text;
}

std::string deleteLine(const std::string& text, Dice& dice) {
  auto lines = linesOf(text);
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(dice.below(lines.size())));
  return joined(lines);
}

std::string doubleLine(const std::string& text, Dice& dice) {
  auto lines = linesOf(text);
  const std::string line = lines[dice.below(lines.size())];
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(dice.below(lines.size())), line);
  return joined(lines);
}

std::string swapLines(const std::string& text, Dice& dice) {
  auto lines = linesOf(text);
  std::swap(lines[dice.below(lines.size())], lines[dice.below(lines.size())]);
  return joined(lines);
}

std::string replaceNumber(std::string text, Dice& dice) {
  static constexpr const char* kValues[] = {
      "0",     "-1",       "1e308",      "1e-308",     "-1e308", "nan",   "inf",
      "-inf",  "5e-324",   "1000000000", "2147483647", "-0.0",   "1e9",   "9223372036854775807",
      "1e400", "\"text\"", "true",       "[]",         "{}",     "[[1]]", "99999999999999999999",
      "1e150", "1e-150",   "3.5",        "200000",     "100000", "1e20",  "1979-05-27"};
  const std::vector<Span> numbers = numbersOf(text);
  if (numbers.empty()) return text;
  const Span span = numbers[dice.below(numbers.size())];
  return text.replace(span.first, span.length, dice.oneOf(kValues));
}

std::string addLine(const std::string& text, Dice& dice) {
  static constexpr const char* kLines[] = {
      "unknown = 1",
      "[unknown]",
      "[[unknown]]",
      "count = 1000000000",
      "name = \"world\"",
      "[[stack]]\ncount = 1000000000",
      "[[grid]]\ncounts = [100000, 100000, 100000]\nshapes = []",
      "[[pyramid]]\nbase = 200000",
      "[[cloth]]\nnodes = [200000, 200000]",
      "[[soft_body]]\nbox = { size = [1, 1, 1], cells = [1000, 1000, 1000] }",
      "[[arm]]\ncount = 10000\nlength = 0.1",
      "[[card_house]]\nstoreys = 1000000000",
      "[simulation]",
      "[gravity]",
      "duration = 1e300",
      "= 3",
      "<geom/>",
      "<joint/>",
      "<body>",
      "</body>",
      "<replicate count='99999'>",
      "<include file='mutated.xml'/>",
      "<inertial mass='1' diaginertia='1 1 9'/>",
      "<link name='base'/>",
      "<!--",
      "]]>",
      "&amp;&#0;&nothing;",
      "[[",
      "\"\"\"",
      "a.b.c.d = {}"};
  auto lines = linesOf(text);
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(dice.below(lines.size())),
               dice.oneOf(kLines));
  return joined(lines);
}

std::string nest(const std::string& text, Dice& dice) {
  const std::size_t depth = std::size_t{1} << (4 + dice.below(13));
  switch (dice.below(4)) {
    case 0:
      return text + "\nx = " + repeated("[", depth) + repeated("]", depth);
    case 1:
      return text + "\nx = " + repeated("{a=", depth) + "1" + repeated("}", depth);
    case 2:
      return text + "\n" + repeated("a.", depth) + "b = 1\n";
    default:
      return text + "\n[" + repeated("a.", depth) + "b]\n";
  }
}

std::string truncate(const std::string& text, Dice& dice) {
  return text.substr(0, dice.below(text.size() + 1));
}

std::string insertGarbage(std::string text, Dice& dice) {
  std::string bytes;
  for (std::size_t i = 0; i <= dice.below(64); ++i) bytes += static_cast<char>(dice.below(256));
  return text.insert(dice.below(text.size() + 1), bytes);
}

std::string encode(const std::string& text, Dice& dice) {
  switch (dice.below(4)) {
    case 0:
      return joined(linesOf(text), "\r\n");
    case 1:
      return "\xEF\xBB\xBF" + text;  // the mark of UTF-8
    case 2:
      return "\xFF\xFE" + text;  // of UTF-16
    default:
      return joined(linesOf(text), "\r");
  }
}

std::string renameKey(std::string text, Dice& dice) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == ' ' && text[i + 1] == '=') ends.push_back(i - 1);
  }
  if (!ends.empty()) text[ends[dice.below(ends.size())]] = 'x';
  return text;
}

std::string doubleAll(const std::string& text, Dice&) { return text + "\n" + text; }

using Mutation = std::string (*)(std::string text, Dice& dice);
template <auto F>
std::string apply(std::string text, Dice& dice) {
  return F(std::move(text), dice);
}

// Numbers and lines more often: they get furthest.
constexpr Mutation kMutations[] = {apply<replaceNumber>, apply<replaceNumber>, apply<replaceNumber>,
                                   apply<replaceNumber>, apply<replaceNumber>, apply<addLine>,
                                   apply<addLine>,       apply<deleteLine>,    apply<doubleLine>,
                                   apply<swapLines>,     apply<renameKey>,     apply<flipByte>,
                                   apply<nest>,          apply<truncate>,      apply<insertGarbage>,
                                   apply<encode>,        apply<doubleAll>};

}  // namespace

std::string mutated(const std::vector<std::string>& scenes, int seed) {
  Dice dice(seed);
  std::string text = scenes[dice.below(scenes.size())];
  const std::size_t times = 1 + dice.below(3);
  for (std::size_t k = 0; k < times; ++k) {
    text = kMutations[dice.below(std::size(kMutations))](std::move(text), dice);
  }
  return text;
}

}  // namespace tests
