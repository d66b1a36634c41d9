// A table of reference values: CSV with '#' lines before its heads, one row per time.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace scenes {

struct ReferenceTable {
  std::vector<std::string> heads;
  std::vector<std::vector<double>> rows;  // a cell that is no number is NaN

  int column(const std::string& head) const;  // -1: none
};

// Throws InputError("file:line: ...").
ReferenceTable parseReferenceTable(const std::string& text, const std::string& path);

// The row at that time, to a millionth of a second; -1: none.
int rowAt(const ReferenceTable& table, int timeColumn, double time);

}  // namespace scenes
