// What a plan says of islands: a line for those that are alike.
#include <fmt/format.h>

#include "app/base/numbers.h"
#include "app/plan/plan.h"

namespace app {

namespace {

using physics::IslandPlan;
using physics::SubstepLaw;

constexpr std::size_t kMostLines = 12, kLongest = 100;

struct LawWord {
  SubstepLaw law;
  const char *word, *text;
};
constexpr LawWord kLaws[] = {
    {SubstepLaw::kLeast, "least", " (the least)"},
    {SubstepLaw::kSag, "sag", " (sag of contacts)"},
    {SubstepLaw::kOverlap, "overlap", " (overlap of points)"},
    {SubstepLaw::kStrain, "strain", " (strain of the mesh)"},
    {SubstepLaw::kTurn, "turn", " (turn in a substep)"},
    {SubstepLaw::kPull, "pull", " (swings of what joints pull)"},
    {SubstepLaw::kApproach, "approach", " (speed of approach)"},
    {SubstepLaw::kOpened, "opened", " (joints that half could not close)"}};

const LawWord& wordsOf(SubstepLaw law) {
  for (const LawWord& words : kLaws) {
    if (words.law == law) return words;
  }
  return kLaws[0];
}

std::string many(int count, const std::string& one, const std::string& more) {
  return fmt::format("{} {}", count, count == 1 ? one : more);
}

std::string accuracyText(const physics::IslandSteps& of) {
  const physics::AccuracyReport& steps = of.steps;
  std::string text = many(steps.accepted, "step", "steps");
  if (steps.rejected > 0) text += fmt::format(" and {} rejected", steps.rejected);
  if (steps.order > 0) text += fmt::format(", order {}", steps.order);
  return text + fmt::format(", each to {:.2g} of {}", of.tolerance, lengthText(of.size));
}

// What an island of which the plan tells that nothing touches it steps by: an accuracy.
std::string freeLine(const PlannedIslands& island) {
  if (!island.steps) return "1 body, flies exactly, in one go";
  return fmt::format("{}; {}", many(island.plan.bodies, "body", "bodies"),
                     accuracyText(*island.steps));
}

std::string lineOf(const PlannedIslands& island) {
  const IslandPlan& p = island.plan;
  if (p.flies) return freeLine(island);
  std::string text = many(p.bodies, "body", "bodies");
  const auto add = [&](const std::string& part) { text += ", " + part; };
  if (p.trees > 0) add(many(p.trees, "tree", "trees"));
  if (p.loops > 0) add(many(p.loops, "loop", "loops"));
  if (p.joints > 0) add(many(p.joints, "joint at once", "joints at once"));
  if (p.ropes > 0) add(many(p.ropes, "rope at once", "ropes at once"));
  if (p.cloths > 0) add(many(p.cloths, "mesh with links at once", "meshes with links at once"));
  if (p.meshes > 0) add(many(p.meshes, "mesh swept", "meshes swept"));
  if (p.contacts > 0) add(many(p.contacts, "contact", "contacts"));
  if (p.atOnce) add("their loads at once");
  if (p.softContacts > 0) add(fmt::format("{} of points", p.softContacts));
  if (island.steps) return text + "; " + accuracyText(*island.steps);
  text += fmt::format("; {}{}", many(p.substeps, "substep", "substeps"), wordsOf(p.law).text);
  text += fmt::format(", {}", many(p.sweeps, "sweep", "sweeps"));
  return text;
}

Json accuracyJson(const physics::IslandSteps& of) {
  return {{"size", of.size},
          {"tolerance", of.tolerance},
          {"steps", of.steps.accepted},
          {"rejected", of.steps.rejected},
          {"order", of.steps.order},
          {"shortest_step", of.steps.least},
          {"error_estimate", of.steps.estimate}};
}

}  // namespace

std::string islandsText(const Plan& plan) {
  if (plan.islands.empty()) return "";
  int islands = 0;
  for (const PlannedIslands& group : plan.islands) islands += group.count;
  std::string text =
      fmt::format("{} in the last of these steps\n", many(islands, "island", "islands"));
  std::size_t lines = 0;
  for (const PlannedIslands& group : plan.islands) {
    if (lines++ == kMostLines) break;
    std::string line = fmt::format("{:>4} x {}", group.count, lineOf(group));
    if (line.size() > kLongest) line = line.substr(0, kLongest - 3) + "...";
    text += line + "\n";
    islands -= group.count;
  }
  return islands > 0 ? text + fmt::format("{:>4} more\n", islands) : text;
}

Json islandsJson(const Plan& plan) {
  Json all = Json::array();
  for (const PlannedIslands& group : plan.islands) {
    const IslandPlan& p = group.plan;
    all.push_back({{"count", group.count},
                   {"first", p.first},
                   {"bodies", p.bodies},
                   {"flies", p.flies && !group.steps},
                   {"trees", p.trees},
                   {"loops", p.loops},
                   {"joints", p.joints},
                   {"ropes", p.ropes},
                   {"cloths", p.cloths},
                   {"meshes", p.meshes},
                   {"links", p.links},
                   {"contacts", p.contacts},
                   {"loads_at_once", p.atOnce},
                   {"soft_contacts", p.softContacts},
                   {"substeps", p.substeps},
                   {"sweeps", p.sweeps},
                   {"asked_by", wordsOf(p.law).word},
                   {"accuracy", group.steps ? accuracyJson(*group.steps) : Json()}});
  }
  return all;
}

}  // namespace app
