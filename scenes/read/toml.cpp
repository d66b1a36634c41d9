// TOML text -> Value; the only file that knows toml++.
#include <fmt/format.h>
#include <toml++/impl/preprocessor.h>
// A header such as "[[=" is a parse error, which toml++ 3.3 has a branch for; but it also states
// that there is none: with assertions it ends the program, without them the branch may be left out
// (github.com/marzer/tomlplusplus/pull/301).
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT_ASSUME(expression) static_assert(true)
// Deciding whether a letter beyond ASCII is white space, toml++ 3.3 calls it unreachable that it is
// none, as in a letter behind a line that ends in a backslash: it is.
#undef TOML_UNREACHABLE
#define TOML_UNREACHABLE return false
// clang-format off
#include <toml++/impl/forward_declarations.h>
#include <toml++/impl/unicode.h>
// clang-format on
#undef TOML_UNREACHABLE
#define TOML_UNREACHABLE __builtin_unreachable()
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "scenes/read/value.h"

namespace scenes {
namespace {

Place placeOf(const toml::source_region& region) {
  return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), {}};
}

Value convert(const toml::node& node);

void convertTable(const toml::table& table, Value& out) {
  out.kind = Value::Kind::kTable;
  for (const auto& [key, node] : table) {
    out.members.push_back({std::string(key.str()), placeOf(key.source()), convert(node)});
  }
  std::stable_sort(out.members.begin(), out.members.end(), [](const Member& a, const Member& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
}

void convertArray(const toml::array& array, Value& out) {
  out.kind = Value::Kind::kArray;
  for (const toml::node& node : array) out.items.push_back(convert(node));
}

Value convert(const toml::node& node) {
  Value out;
  out.place = placeOf(node.source());
  if (const auto* table = node.as_table()) {
    convertTable(*table, out);
  } else if (const auto* array = node.as_array()) {
    convertArray(*array, out);
  } else if (const auto* boolean = node.as_boolean()) {
    out.kind = Value::Kind::kBoolean;
    out.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    out.kind = Value::Kind::kInteger;
    out.integer = integer->get();
    out.number = static_cast<double>(out.integer);
  } else if (const auto* number = node.as_floating_point()) {
    out.kind = Value::Kind::kNumber;
    out.number = number->get();
  } else if (const auto* text = node.as_string()) {
    out.kind = Value::Kind::kString;
    out.text = text->get();
  } else {
    out.kind = Value::Kind::kDate;
  }
  return out;
}

// Every part of a dotted key is a table in a table, which toml++ and convert() walk by recursion.
constexpr int kMostParts = 16;

// The end of the string that begins at `at`: behind its closing quotes, or the end of the text.
std::size_t endOfString(const std::string& text, std::size_t at) {
  const char quote = text[at];
  const std::size_t quotes = text.compare(at, 3, std::string(3, quote)) == 0 ? 3 : 1;
  for (std::size_t i = at + quotes; i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (text.compare(i, quotes, std::string(quotes, quote)) == 0) {
      return i + quotes;
    } else if (text[i] == '\n' && quotes == 1) {
      return i;
    }
  }
  return text.size();
}

void checkKeys(const std::string& text, const std::string& path) {
  int parts = 1, line = 1;
  std::size_t lineStart = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      const std::size_t end = endOfString(text, i);
      for (; i < end; ++i) {
        if (text[i] == '\n') ++line, lineStart = i + 1;
      }
      continue;
    }
    if (c == '#') {
      while (i < text.size() && text[i] != '\n') ++i;
      continue;
    }
    if (c == '\n') ++line, lineStart = i + 1;
    const bool inKey = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' ||
                       c == ' ' || c == '\t';
    if (c != '.' && !inKey) parts = 1;
    if (c == '.' && ++parts > kMostParts) {
      throw InputError(fmt::format("{}:{}:{}: expected a key of at most {} parts", path, line,
                                   i - lineStart + 1, kMostParts));
    }
    ++i;
  }
}

// How many bytes a letter takes that begins with these, 0 where they are no UTF-8: a stray or
// missing continuation, a longer form than needed, half of a UTF-16 pair, or past U+10FFFF.
std::size_t lengthOfLetter(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned first = at(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || bytes.size() < length) return 0;
  unsigned code = first & (0xff >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((at(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (at(i) & 0x3f);
  }
  constexpr unsigned kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool isHalf = code >= 0xd800 && code < 0xe000;
  return code < kLeast[length] || code > 0x10ffff || isHalf ? 0 : length;
}

}  // namespace

// A column is a letter, as toml++ counts.
void checkLetters(const std::string& text, const std::string& path) {
  int line = 1, column = 1;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = lengthOfLetter(std::string_view(text).substr(i));
    if (length == 0) {
      throw InputError(fmt::format("{}:{}:{}: expected UTF-8, got the byte {:#04x}", path, line,
                                   column, static_cast<unsigned char>(text[i])));
    }
    const bool ends = text[i] == '\n';
    line += ends ? 1 : 0;
    column = ends ? 1 : column + 1;
    i += length;
  }
}

Value parseToml(const std::string& text, const std::string& path) {
  checkLetters(text, path);
  checkKeys(text, path);
  try {
    return convert(toml::parse(text, path));
  } catch (const toml::parse_error& error) {
    const Place place = placeOf(error.source());
    throw InputError(fmt::format("{}:{}:{}: expected TOML: {}", path, place.line, place.column,
                                 error.description()));
  }
}

}  // namespace scenes
