// Reads tables of reference values.
#include "scenes/read/reference_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "scenes/read/input_error.h"

namespace scenes {
namespace {

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t from = 0;
  while (true) {
    const std::size_t comma = line.find(',', from);
    cells.push_back(line.substr(from, comma - from));
    if (comma == std::string::npos) return cells;
    from = comma + 1;
  }
}

double numberOf(const std::string& cell) {
  char* end = nullptr;
  const double number = std::strtod(cell.c_str(), &end);
  return end == cell.c_str() ? std::numeric_limits<double>::quiet_NaN() : number;
}

}  // namespace

int ReferenceTable::column(const std::string& head) const {
  const auto found = std::find(heads.begin(), heads.end(), head);
  return found == heads.end() ? -1 : static_cast<int>(found - heads.begin());
}

ReferenceTable parseReferenceTable(const std::string& text, const std::string& path) {
  ReferenceTable table;
  std::size_t from = 0;
  for (int number = 1; from < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::string line = text.substr(from, end - from);
    from = end + 1;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> cells = cellsOf(line);
    if (table.heads.empty()) {
      table.heads = cells;
      continue;
    }
    if (cells.size() != table.heads.size()) {
      throw InputError(fmt::format("{}:{}: expected {} cells, got {}", path, number,
                                   table.heads.size(), cells.size()));
    }
    table.rows.emplace_back();
    for (const std::string& cell : cells) table.rows.back().push_back(numberOf(cell));
  }
  if (table.rows.empty()) throw InputError(path + ": expected a line of heads and at least a row");
  return table;
}

int rowAt(const ReferenceTable& table, int timeColumn, double time) {
  constexpr double kSlack = 1e-6;  // s
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (std::abs(table.rows[row][static_cast<std::size_t>(timeColumn)] - time) <= kSlack) {
      return static_cast<int>(row);
    }
  }
  return -1;
}

}  // namespace scenes
