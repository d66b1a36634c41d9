// What the test of physics/paper.md reads: the table's rows, the names that sources declare, and
// the tests there are.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace tests {

// A row of the index: | equations | function | test | verdict |
struct Row {
  int line = 0;
  std::size_t cells = 0;
  std::vector<int> equations;  // of the ranges that its first cell begins with: (1), (3)-(5)
  std::vector<std::string> names, tests;  // in backticks in the second and the third cell
  std::string verdict;
};
std::vector<Row> rowsOf(const std::string& text);

// Of the source tree, by path from its root.
std::string textOf(const std::string& path);

using Sources = std::map<std::string, std::string>;  // file's name: text, comments left out
Sources sourcesIn(const std::string& folder);

// A type, a function, Type::member or the name of a file.
bool isDeclared(const std::string& name, const Sources& sources);

// "Suite.Name", and "Prefix/Suite.Name" for every instantiation with a prefix.
std::set<std::string> testsIn(const std::string& folder);

// Whether a name, or "Suite.*", matches one of them. A suite's prefix may be left out.
bool matchesAny(const std::string& pattern, const std::set<std::string>& names);

}  // namespace tests
