// Bisection finds borders that are known with few trials, and the map shows them.
#include <gtest/gtest.h>

#include <cmath>

#include "app/study/chart.h"
#include "app/base/numbers.h"
#include "app/study/severity_search.h"
#include "app/study/stability.h"

namespace app {
namespace {

using scenes::StabilitySeverity;
using Scale = StabilitySeverity::Scale;

StabilitySeverity severityOf(double from, double stated, double to, Scale scale = Scale::kLog) {
  StabilitySeverity severity;
  severity.from = from;
  severity.to = to;
  severity.stated = stated;
  severity.scale = scale;
  return severity;
}

TEST(SeveritySearch, FindsAKnownBorderWithinAHundredthOfTheRange) {
  for (const double border : {1.5e3, 4.2e4, 0.9e6}) {
    const SeverityBorder found = searchSeverity(
        severityOf(1, 1000, 1e6), [&](double level) { return std::optional(level < border); });
    ASSERT_TRUE(found.holds && found.fails);
    EXPECT_LT(*found.holds, border);
    EXPECT_GE(*found.fails, border);
    EXPECT_LT(std::log10(*found.fails / *found.holds), 0.06);  // 6 decades * 0.01
    EXPECT_FALSE(found.holdsBeyond);
    EXPECT_LE(found.trials.size(), static_cast<std::size_t>(kMostTrials));
  }
}

TEST(SeveritySearch, FindsAWholeNumberExactly) {
  const SeverityBorder found =
      searchSeverity(severityOf(2, 10, 40, Scale::kInteger),
                     [](double level) { return std::optional(level <= 23); });
  EXPECT_EQ(found.holds, 23);
  EXPECT_EQ(found.fails, 24);
}

TEST(SeveritySearch, GoesTowardsSmallerLevelsWhereLessIsHarder) {
  const SeverityBorder found =
      searchSeverity(severityOf(64, 8, 1, Scale::kInteger),
                     [](double level) { return std::optional(level >= 3); });
  EXPECT_EQ(found.holds, 3);
  EXPECT_EQ(found.fails, 2);
}

TEST(SeveritySearch, LooksBelowAStatedLevelThatFails) {
  const SeverityBorder found = searchSeverity(
      severityOf(1, 1000, 1e6), [](double level) { return std::optional(level < 30); });
  ASSERT_TRUE(found.holds && found.fails);
  EXPECT_GT(*found.holds, 25);
  EXPECT_LE(*found.fails, 35);
  for (const SeverityTrial& trial : found.trials) EXPECT_LE(trial.level, 1000);
}

TEST(SeveritySearch, SaysThatNothingFailsOrNothingHolds) {
  const auto always = [](bool holds) {
    return searchSeverity(severityOf(1, 1000, 1e6), [=](double) { return std::optional(holds); });
  };
  EXPECT_EQ(always(true).holds, 1e6);
  EXPECT_FALSE(always(true).fails);
  EXPECT_EQ(always(false).fails, 1);
  EXPECT_FALSE(always(false).holds);
}

// Fails from 10 to 300 as well as from 9e4 on: the border is where it fails first.
TEST(SeveritySearch, ReportsALevelThatFailsBelowTheBorder) {
  const SeverityBorder found = searchSeverity(severityOf(1, 3, 1e6), [](double level) {
    return std::optional(level < 10 || (level > 300 && level < 9e4));
  });
  ASSERT_TRUE(found.fails && found.holds && found.holdsBeyond);
  EXPECT_LT(*found.fails, 300);
  EXPECT_LT(*found.holds, 10);
  EXPECT_GT(*found.holdsBeyond, 300);
  EXPECT_LE(found.trials.size(), static_cast<std::size_t>(kMostTrials));
}

// Empty: there is no map.
std::string scriptOf(const StabilityResult& result) {
  const auto chart = mapOf({&result}, "Family", "map");
  return chart ? chartScript(*chart) : "";
}

TEST(SeverityMap, WritesLevelsAsPeopleDo) {
  EXPECT_EQ(levelText(0), "0");
  EXPECT_EQ(levelText(0.49995), "0.49995");
  EXPECT_EQ(levelText(13300), "13300");
  EXPECT_EQ(levelText(-1e7), "-1e7");
  EXPECT_EQ(levelText(3.2e-5), "3.2e-5");
}

TEST(SeverityMap, HasABarForEachMethodAndNamesWhatFails) {
  StabilityResult result;
  result.study.title = "A_case";
  result.study.severity = severityOf(1, 1000, 1e6);
  StabilityBar bar;
  bar.way = {"", "direct", "#0072b2", {}};
  bar.border.holds = 1e4;
  bar.border.fails = 2e4;
  bar.firstFailure.emplace();
  bar.firstFailure->status = Trace::Status::kFails;
  bar.firstFailure->failure = {34, 0.5, "overlap 0.2 m, expected <= 0.1 m", "a, b", "contact"};
  result.bars.push_back(bar);
  EXPECT_EQ(borderText(bar), "at 20000: overlap, a, b, frame 34");
  const std::string script = scriptOf(result);
  for (const char* part : {"A\\\\_case", "{/:Bold direct}", "'#0072b2'", "overlap, a, b, frame 34",
                           "set output 'map.svg'", "stated: 1000"}) {
    EXPECT_NE(script.find(part), std::string::npos) << part << "\n" << script;
  }
  result.bars.clear();
  EXPECT_EQ(scriptOf(result), "");
}

TEST(SeverityMap, SaysWhereASearchWasCutShort) {
  StabilityBar bar;
  bar.way = {"", "direct", "#0072b2", {}};
  EXPECT_EQ(borderText(bar), "not tried");
  bar.border.holds = 1000;
  EXPECT_EQ(borderText(bar), "holds to the end of the range");
  bar.isSpent = true;
  EXPECT_EQ(borderText(bar), "not tried beyond: too much work");
  bar.border.fails = 2e4;
  EXPECT_EQ(borderText(bar), "at 20000: fails; cut short");

  StabilityResult result;
  result.study.severity = severityOf(1, 1000, 1e6);
  result.bars.push_back(bar);
  EXPECT_NE(severityText(result).find("; cut short"), std::string::npos);
  result.bars[0].border.fails.reset();
  EXPECT_NE(severityText(result).find("holds to 1000, not tried beyond"), std::string::npos);
  const std::string script = scriptOf(result);
  EXPECT_EQ(script.find("head filled"), std::string::npos) << "an arrow past the end of the range";
}

TEST(SeveritySearch, EndsWhereItIsStopped) {
  int trials = 0;
  const SeverityBorder found =
      searchSeverity(severityOf(1, 3, 1e6), [&](double) -> std::optional<bool> {
        if (++trials == 4) return std::nullopt;
        return true;
      });
  EXPECT_TRUE(found.stopped);
  EXPECT_EQ(trials, 4);
}

}  // namespace
}  // namespace app
