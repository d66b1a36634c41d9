// What a study found, as tables, diagrams, pictures and words; written as a page, its diagrams and
// CSV.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/study/chart.h"

namespace app {

struct ReportCell {
  enum class Look { kPlain, kNumber, kQuiet, kGood, kBad };
  std::string text;
  Look look = Look::kPlain;
  std::string link;  // a section's id

  ReportCell(std::string words = "", Look how = Look::kPlain, std::string to = "")
      : text(std::move(words)), look(how), link(std::move(to)) {}
};
ReportCell number(std::string text);

struct ReportText {  // a paragraph
  std::string text;
  ReportCell::Look look = ReportCell::Look::kPlain;
  bool isCode = false;
  std::string file{};  // named at its end, with a link
};
struct ReportTable {
  std::vector<std::string> heads;
  std::vector<std::vector<ReportCell>> rows;
  std::string foldedUnder{};  // a summary; empty: it stands open
};
struct ReportShots {
  std::vector<std::pair<std::string, std::string>> files;  // those that are there, and captions
  std::string foldedUnder{};
};
using ReportBlock = std::variant<ReportText, ReportTable, ReportShots, Chart>;

struct ReportSection {
  std::string id, title;
  std::vector<ReportBlock> blocks;
  bool isHead = false;  // a heading of those that follow, without a frame of its own
};

struct Report {
  std::string title, command;
  std::string note;  // "load average 0.3"
  std::vector<ReportSection> sections;
  std::vector<std::pair<std::string, std::string>> tables;  // CSV: a file's name and its text
};

// index.html, the diagrams where gnuplot is there, and the tables. Gives the page's path.
std::filesystem::path writeReport(const Report& report, const std::filesystem::path& folder);

std::string csvCell(std::string text);  // without commas and line ends

}  // namespace app
