// Reading of physics/paper.md, of declarations and of tests.
#include "index.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace tests {
namespace {

namespace fs = std::filesystem;

using Strings = std::vector<std::string>;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

Strings cellsOf(const std::string& line) {
  Strings cells;
  std::istringstream in(line.substr(1));
  for (std::string cell; std::getline(in, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

std::vector<int> equationsOf(std::string cell) {
  static const std::regex kRange(R"(^(?:, )?\((\d+)\)(?:-\((\d+)\))?)");
  std::vector<int> equations;
  for (std::smatch match; std::regex_search(cell, match, kRange); cell = match.suffix()) {
    const int first = std::stoi(match[1]), last = match[2].matched ? std::stoi(match[2]) : first;
    for (int k = first; k <= last; ++k) equations.push_back(k);
  }
  return equations;
}

Strings inBackticks(const std::string& cell) {
  Strings names;
  for (std::size_t open = cell.find('`'); open != std::string::npos;) {
    const std::size_t close = cell.find('`', open + 1);
    if (close == std::string::npos) break;
    names.push_back(cell.substr(open + 1, close - open - 1));
    open = cell.find('`', close + 1);
  }
  return names;
}

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string withoutComments(const std::string& text) {
  std::string code;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) code += line.substr(0, line.find("//")) + "\n";
  return code;
}

bool isWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// Where a whole word stands in a text, from a place on.
std::size_t findWord(const std::string& text, const std::string& word, std::size_t from = 0) {
  for (std::size_t k = text.find(word, from); k != std::string::npos; k = text.find(word, k + 1)) {
    const std::size_t end = k + word.size();
    if ((k == 0 || !isWord(text[k - 1])) && (end >= text.size() || !isWord(text[end]))) return k;
  }
  return std::string::npos;
}

bool isType(const std::string& text, const std::string& name) {
  for (const char* keyword : {"struct ", "class ", "concept ", "using "}) {
    if (findWord(text, keyword + name) != std::string::npos) return true;
  }
  return false;
}

bool isFunction(const std::string& text, const std::string& name) {
  for (std::size_t k = findWord(text, name); k != std::string::npos;
       k = findWord(text, name, k + 1)) {
    const bool ofAnother =
        k > 0 && (text[k - 1] == '.' || text[k - 1] == ':' || text[k - 1] == '>');
    if (!ofAnother && text[k + name.size()] == '(') return true;
  }
  return false;
}

// The body of a type: from its opening brace to the one that closes it.
std::string bodyOf(const std::string& text, const std::string& type) {
  for (const char* keyword : {"struct ", "class "}) {
    const std::size_t start = findWord(text, keyword + type);
    const std::size_t open = start == std::string::npos ? start : text.find_first_of("{;", start);
    if (open == std::string::npos || text[open] == ';') continue;
    int depth = 0;
    for (std::size_t k = open; k < text.size(); ++k) {
      depth += text[k] == '{' ? 1 : text[k] == '}' ? -1 : 0;
      if (depth == 0) return text.substr(open, k - open);
    }
  }
  return "";
}

}  // namespace

std::vector<Row> rowsOf(const std::string& text) {
  std::vector<Row> rows;
  std::istringstream in(text);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (!line.starts_with("| ") || line.starts_with("| equations")) continue;
    const Strings cells = cellsOf(line);
    Row row{number, cells.size(), equationsOf(cells[0]), {}, {}, cells.back()};
    if (cells.size() > 2) row.names = inBackticks(cells[1]), row.tests = inBackticks(cells[2]);
    rows.push_back(row);
  }
  return rows;
}

std::string textOf(const std::string& path) { return read(fs::path(DBD_SOURCE) / path); }

Sources sourcesIn(const std::string& folder) {
  Sources sources;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(DBD_SOURCE) / folder)) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".h" && ending != ".cpp") continue;
    sources[fs::relative(entry.path(), DBD_SOURCE).string()] = withoutComments(read(entry.path()));
  }
  return sources;
}

bool isDeclared(const std::string& name, const Sources& sources) {
  const std::size_t colons = name.find("::");
  return std::any_of(sources.begin(), sources.end(), [&](const auto& source) {
    const auto& [path, text] = source;
    if (name.ends_with(".h") || name.ends_with(".cpp")) return fs::path(path).filename() == name;
    if (colons == std::string::npos) return isType(text, name) || isFunction(text, name);
    const std::string body = bodyOf(text, name.substr(0, colons));
    return findWord(body, name.substr(colons + 2)) != std::string::npos;
  });
}

std::set<std::string> testsIn(const std::string& folder) {
  static const std::regex kTest(R"(\b(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  static const std::regex kPrefix(R"(\bINSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+),)");
  std::set<std::string> names;
  std::multimap<std::string, std::string> prefixes;
  for (const auto& [path, text] : sourcesIn(folder)) {
    for (std::sregex_iterator k(text.begin(), text.end(), kTest), end; k != end; ++k) {
      names.insert((*k)[1].str() + "." + (*k)[2].str());
    }
    for (std::sregex_iterator k(text.begin(), text.end(), kPrefix), end; k != end; ++k) {
      prefixes.emplace((*k)[2], (*k)[1]);
    }
  }
  std::set<std::string> all = names;
  for (const std::string& name : names) {
    const auto [first, last] = prefixes.equal_range(name.substr(0, name.find('.')));
    for (auto k = first; k != last; ++k) all.insert(k->second + "/" + name);
  }
  return all;
}

bool matchesAny(const std::string& pattern, const std::set<std::string>& names) {
  if (!pattern.ends_with(".*")) return names.contains(pattern);
  const std::string suite = pattern.substr(0, pattern.size() - 1);  // with its dot
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return name.starts_with(suite); });
}

}  // namespace tests
