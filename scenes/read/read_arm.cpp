// [[arm]] and the scripts of its target.
#include "scenes/read/read_arm.h"

#include <fmt/format.h>

#include "scenes/read/read_body.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;
using physics::Vec3;

void readTargets(TableReader& reader, ArmScript& script) {
  const Value* targets = reader.take("targets");
  if (targets == nullptr) return;
  const Spot spot = reader.spot({"targets"});
  if (!targets->isArray() || targets->items.empty()) {
    failExpected(spot, *targets, "an array of targets { time, at }");
  }
  for (const Value& item : targets->items) {
    if (!item.isTable()) failExpected(spot, item, "a table { time, at }");
    TableReader key(item, "arm.targets", reader.context());
    ArmScript::Key read;
    key(Field{"time", Unit::kNone, true, 0}, read.time);
    key(Field{"at", Unit::kPoint, true}, read.at);
    key(Field{"jump"}, read.jump);
    key.finish();
    if (!script.keys.empty() && read.time <= script.keys.back().time) {
      key.failAt("time", fmt::format("expected times that increase, got {} after {}", read.time,
                                     script.keys.back().time));
    }
    script.keys.push_back(read);
  }
}

void readFollow(TableReader& reader, const Recipe& recipe, ArmScript& script) {
  std::string name;
  reader(Field{"follow"}, name);
  if (!reader.has("follow")) return;
  const Built& trial = recipe.trial();
  const auto found = trial.ids.find(name);
  if (found == trial.ids.end()) {
    reader.failAt("follow", fmt::format("no body '{}'{}", name, didYouMean(name, trial.names)));
  }
  script.follow = found->second;
}

// Where the target is before the first step.
void setStart(const Recipe& recipe, const ArmScript& script, physics::ArmDef& def) {
  if (!script.keys.empty()) def.target = script.keys.front().at;
  if (script.follow >= 0) def.target = recipe.trial().world.bodies().pose[script.follow].x;
}

void build(Built& built, const physics::ArmDef& def, ArmScript script, const std::string& name,
           const std::optional<render::Color>& color) {
  script.arm = built.world.add(def);
  const std::vector<physics::BodyId> bodies = built.world.arms().back().bodies;
  const int hue = built.families++;
  for (size_t k = 0; k < bodies.size(); ++k) {
    const auto own = familyColor(Pattern::kAlternate, hue, static_cast<int>(k));
    built.name(bodies[k], fmt::format("{}.{}", name, k), color.value_or(own));
  }
  built.alias(bodies.back(), name + ".end");
  if (!script.keys.empty() || script.follow >= 0) built.armScripts.push_back(std::move(script));
}

}  // namespace

void readArm(TableReader& reader, Recipe& recipe) {
  const std::string name = readName(reader, physics::ArmDef::kWord);
  physics::ArmDef def;
  ArmScript script;
  physics::ArmDef::fields(reader, def);
  readLinks(reader, def);
  reader(Field{"target", Unit::kPoint}, def.target);
  readTargets(reader, script);
  readFollow(reader, recipe, script);
  reader.atMostOne("target", "targets");
  reader.atMostOne("target", "follow");
  reader.atMostOne("targets", "follow");
  setStart(recipe, script, def);
  std::optional<render::Color> color;
  readColor(reader, color);
  recipe.add(reader, [=](Built& built) { build(built, def, script, name, color); });
}

}  // namespace scenes
