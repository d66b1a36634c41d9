// The plan for a terminal.
#include <fmt/format.h>

#include <algorithm>

#include "app/plan/plan.h"
#include "app/base/numbers.h"

namespace app {

namespace {

constexpr std::size_t kColumns = 100;

std::string bytesText(std::size_t bytes) {
  if (bytes == 0) return "";
  if (bytes < 10'000) return fmt::format("{} B", bytes);
  return bytes < 10'000'000 ? fmt::format("{} kB", bytes / 1000)
                            : fmt::format("{} MB", bytes / 1'000'000);
}

std::string cut(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  if (line.size() > kColumns) line = line.substr(0, kColumns - 3) + "...";
  return line + "\n";
}

std::string countText(const scenes::Effect& e) {
  std::string text;
  if (e.count > 0)
    text = e.unit.empty() ? std::to_string(e.count) : fmt::format("{} {}", e.count, e.unit);
  return e.rows > 0 ? fmt::format("{}, {} rows", text, e.rows) : text;
}

std::string shareOf(const PlannedEffect& planned) {
  if (planned.share) return fmt::format("{:.1f} %", 100 * *planned.share);
  return planned.within.empty() ? "" : "in " + planned.within;
}

std::string headText(const Plan& plan) {
  const StepMeasure& s = plan.step;
  std::string text = cut(fmt::format("{}: {}", plan.name, plan.title));
  text += cut(plan.how);
  text += cut(fmt::format("{} bodies: {} move, {} of them are points; {} rows; {} held",
                          plan.bodies, plan.moving, plan.points, plan.rows,
                          plan.bytes > 0 ? bytesText(plan.bytes) : "nothing"));
  text += cut(
      fmt::format("each step: {:.4g} sweeps, {:.4g} evaluations, {:.4g} pairs tested, {:.4g} kept, "
                  "{:.4g} points press",
                  s.sweeps, s.evaluations, plan.pairsTested, plan.pairsKept, s.contacts));
  if (s.repeats > 0) {
    text += cut(fmt::format("{} a step (median of {} runs of {} steps, {:.0f} % apart)",
                            secondsText(s.seconds), s.repeats, s.steps, 100 * s.spread));
  }
  if (!s.problem.empty()) text += cut(s.problem);
  return text;
}

// What is off, by reason in the order of the table; kinds that have no table share one.
std::string offText(const Plan& plan) {
  std::vector<std::pair<std::string, std::string>> byReason;
  for (const PlannedEffect& planned : plan.effects) {
    const scenes::Effect& e = planned.effect;
    if (e.on) continue;
    const bool isAbsent = e.why == "no [[" + e.name + "]]";
    const std::string why = isAbsent ? "no such table" : e.why;
    auto found = std::find_if(byReason.begin(), byReason.end(),
                              [&](const auto& entry) { return entry.first == why; });
    if (found == byReason.end()) found = byReason.insert(found, {why, ""});
    found->second += (found->second.empty() ? "" : ", ") + e.name;
  }
  std::string text = "off because\n";
  for (const auto& [why, names] : byReason) {
    text += cut(why);
    for (std::size_t from = 0; from < names.size();) {
      std::size_t length = std::min(names.size() - from, kColumns - 4);
      if (from + length < names.size()) length = names.rfind(' ', from + length) - from + 1;
      text += cut("    " + names.substr(from, length));
      from += length;
    }
  }
  return text;
}

}  // namespace

std::string planText(const Plan& plan) {
  std::string on = cut(
      fmt::format("{:<20}{:>22} {:>8} {:>11}  {}", "on", "", "bytes", "of a step", "because of"));
  for (const PlannedEffect& planned : plan.effects) {
    const scenes::Effect& e = planned.effect;
    if (!e.on) continue;
    on += cut(fmt::format("{:<20}{:>22} {:>8} {:>11}  {}", e.name, countText(e),
                          bytesText(planned.bytes), shareOf(planned), e.why));
  }
  on += cut(fmt::format("{:<20}{:>22} {:>8} {:>9.1f} %  velocities, checks, bookkeeping",
                        "the rest", "", "", 100 * plan.rest));
  return headText(plan) + islandsText(plan) + "\n" + on + "\n" + offText(plan);
}

}  // namespace app
