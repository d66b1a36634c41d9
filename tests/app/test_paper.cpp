// physics/paper.md against the sources: every equation of the paper has its row, and every function
// and test that a row names exists.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "index.h"

namespace tests {
namespace {

constexpr int kLastEquation = 154;

const std::vector<Row>& rows() {
  static const std::vector<Row> all = rowsOf(textOf("physics/paper.md"));
  return all;
}
const Sources& physics() {
  static const Sources sources = sourcesIn("physics");
  return sources;
}
const std::set<std::string>& tests() {
  static const std::set<std::string> names = testsIn("tests");
  return names;
}

std::string at(const Row& row) { return "physics/paper.md:" + std::to_string(row.line) + ": "; }

TEST(PaperIndex, HasEveryEquationOnce) {
  std::map<int, int> count;
  for (const Row& row : rows()) {
    for (const int equation : row.equations) ++count[equation];
  }
  for (int equation = 1; equation <= kLastEquation; ++equation) {
    EXPECT_EQ(count[equation], 1) << "equation (" << equation << ") is in " << count[equation]
                                  << " rows of physics/paper.md";
  }
  for (const auto& [equation, times] : count) {
    EXPECT_TRUE(equation >= 1 && equation <= kLastEquation) << "there is no (" << equation << ")";
  }
}

TEST(PaperIndex, RowsSayWhatWhereAndWhetherItIsAsPrinted) {
  for (const Row& row : rows()) {
    ASSERT_EQ(row.cells, 4u) << at(row) << "expected equations | function | test | verdict";
    EXPECT_FALSE(row.names.empty()) << at(row) << "no function";
    EXPECT_FALSE(row.tests.empty()) << at(row) << "no test";
    const bool printed = row.verdict.starts_with("as printed");
    const bool corrected = row.verdict.starts_with("corrected: ");
    EXPECT_TRUE(printed || corrected) << at(row) << "expected 'as printed' or 'corrected: reason'";
    const bool shown = std::any_of(row.tests.begin(), row.tests.end(), [](const std::string& test) {
      return test.starts_with("Erratum");
    });
    EXPECT_TRUE(printed || shown) << at(row) << "no Erratum test shows that the print fails";
  }
}

TEST(PaperIndex, NamesFunctionsAndTypesOfPhysics) {
  for (const Row& row : rows()) {
    for (const std::string& name : row.names) {
      EXPECT_TRUE(isDeclared(name, physics())) << at(row) << "no '" << name << "' in physics/";
    }
  }
}

TEST(PaperIndex, NamesTestsThatExist) {
  for (const Row& row : rows()) {
    for (const std::string& test : row.tests) {
      EXPECT_TRUE(matchesAny(test, tests())) << at(row) << "no test '" << test << "' in tests/";
    }
  }
}

TEST(PaperIndex, ListsEveryErratumThatATestShows) {
  for (const std::string& test : tests()) {
    if (!test.starts_with("Erratum")) continue;
    const bool listed = std::any_of(rows().begin(), rows().end(), [&](const Row& row) {
      return std::any_of(row.tests.begin(), row.tests.end(),
                         [&](const std::string& pattern) { return matchesAny(pattern, {test}); });
    });
    EXPECT_TRUE(listed) << "no row of physics/paper.md names " << test;
  }
}

TEST(PaperIndex, RefersToDeparturesThatAreThere) {
  const std::string text = textOf("physics/paper.md");
  static const std::regex kDeparture(R"(departures? (\d+)(?: and (\d+))?)");
  for (const Row& row : rows()) {
    std::smatch match;
    if (!std::regex_search(row.verdict, match, kDeparture)) continue;
    for (int k = 1; k <= 2; ++k) {
      if (!match[k].matched) continue;
      std::string heading = "\n";  // in steps: g++ 12 warns of the sum without a reason
      heading += match[k].str();
      heading += ". **";
      const bool found = text.find(heading) != std::string::npos;
      EXPECT_TRUE(found) << at(row) << "there is no departure " << match[k];
    }
  }
}

// The checks above can fail.
TEST(PaperIndexReader, TakesRangesAndListsOfEquations) {
  const std::vector<Row> read = rowsOf(
      "| equations | function | test | verdict |\n|---|---|---|---|\n"
      "| (3), (5)-(7) a word (9) | `f` | `A.b`, `C.*` | as printed |\n"
      "| after (54) | `f`, `G::h` | `A.b` | corrected: x |\n");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].equations, (std::vector<int>{3, 5, 6, 7}));
  EXPECT_EQ(read[0].line, 3);
  EXPECT_EQ(read[0].tests, (std::vector<std::string>{"A.b", "C.*"}));
  EXPECT_TRUE(read[1].equations.empty());
  EXPECT_EQ(read[1].names, (std::vector<std::string>{"f", "G::h"}));
}

TEST(PaperIndexReader, FindsWhatIsDeclaredAndNothingElse) {
  const Sources sources = {{"a.h",
                            "struct Box { double width; void open(int); };\nenum class Kind {\n"
                            "kNone };\ninline double areaOf(const Box& box);\n"}};
  for (const char* name : {"Box", "areaOf", "Box::width", "Box::open", "Kind::kNone", "a.h"}) {
    EXPECT_TRUE(isDeclared(name, sources)) << name;
  }
  for (const char* name : {"Bo", "area", "width", "Box::kNone", "Kind::width", "b.h", "Of::a"}) {
    EXPECT_FALSE(isDeclared(name, sources)) << name;
  }
}

TEST(PaperIndexReader, MatchesTestsByNameSuiteAndPrefix) {
  const std::set<std::string> names = {"Box.Opens", "Box.Closes", "Of/Each.Opens"};
  for (const char* pattern : {"Box.Opens", "Box.*", "Of/Each.*"}) {
    EXPECT_TRUE(matchesAny(pattern, names)) << pattern;
  }
  for (const char* pattern : {"Box.Open", "Bo.*", "*", "Each.Closes", "As/Each.*", "BoxxOpens"}) {
    EXPECT_FALSE(matchesAny(pattern, names)) << pattern;
  }
}

}  // namespace
}  // namespace tests
