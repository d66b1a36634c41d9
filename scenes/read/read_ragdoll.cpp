// [[ragdoll]]: a skeleton in a pose, limp or driven through a sequence of poses.
#include <fmt/format.h>

#include "scenes/read/ragdoll_words.h"
#include "scenes/read/read_body.h"

namespace scenes {
namespace {

using physics::Field;

Value nameValue(const char* name) {
  Value value;
  value.kind = Value::Kind::kString;
  value.text = name;
  return value;
}

void readPoses(TableReader& reader, RagdollWords& words) {
  const Value* poses = reader.take("poses");
  if (poses == nullptr) return;
  const Spot spot = reader.spot({"poses"});
  if (!poses->isArray() || poses->items.empty()) failExpected(spot, *poses, "an array of poses");
  if (!words.def.drive)
    reader.failAt("poses", "expected a 'drive' as well, which follows the poses");
  for (const Value& item : poses->items) {
    if (!item.isTable()) failExpected(spot, item, "a table { time, pose }");
    TableReader key(item, "ragdoll.poses", reader.context());
    double time = 0;
    key(Field{"time", physics::Unit::kNone, true, 0}, time);
    const Value* pose = key.take("pose");
    if (pose == nullptr) key.failHere("expected a value for 'pose'");
    key.finish();
    auto& keys = words.script.keys;
    if (!keys.empty() && time <= keys.back().time) {
      key.failAt("time", fmt::format("expected times that increase, got {} after {}", time,
                                     keys.back().time));
    }
    const auto turns = readTurns(*pose, key.spot({"pose"}), words.skeleton);
    if (keys.empty() && !reader.has("pose")) words.start = turns;
    keys.push_back({time, targetsOf(words.skeleton, turns)});
  }
}

void readRepeat(TableReader& reader, PoseScript& script) {
  reader(Field{"repeat"}, script.repeat);
  if (script.repeat && script.keys.size() < 2) {
    reader.failAt("repeat", "expected at least two 'poses' to repeat");
  }
}

void checkFixed(const TableReader& reader, const RagdollWords& words) {
  std::vector<std::string> known;
  for (const physics::Bone& bone : words.skeleton.bones) known.push_back(bone.name);
  for (const std::string& name : words.def.fixed) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    reader.failAt("fixed", fmt::format("no bone '{}'{}", name, didYouMean(name, known)));
  }
}

void build(Built& built, const RagdollWords& words, const std::string& name,
           const std::optional<render::Color>& color) {
  const auto figures = physics::add(built.world, words.skeleton, words.start, words.def);
  for (size_t k = 0; k < figures.size(); ++k) {
    const int hue = built.families++;
    for (size_t i = 0; i < figures[k].bones.size(); ++i) {
      const std::string& bone = words.skeleton.bones[i].name;
      const auto own = familyColor(Pattern::kAlternate, hue, static_cast<int>(i));
      built.name(figures[k].bones[i], fmt::format("{}.{}.{}", name, k, bone), color.value_or(own));
      if (figures.size() == 1) built.alias(figures[k].bones[i], name + "." + bone);
    }
    if (words.script.keys.empty()) continue;
    PoseScript script = words.script;
    script.drives = figures[k].drives;
    if (words.def.leads) {
      script.root = figures[k].bones[0];
      script.start = built.world.bodies().pose[script.root];
    }
    built.scripts.push_back(std::move(script));
  }
}

}  // namespace

std::vector<physics::Quat> targetsOf(const physics::Skeleton& skeleton,
                                     const physics::JointTurns& turns) {
  std::vector<physics::Quat> targets;
  for (size_t i = 0; i < turns.size(); ++i) {
    targets.push_back(physics::driveTarget(skeleton, static_cast<int>(i), turns[i]));
  }
  return targets;
}

void readFigure(TableReader& reader, Recipe& recipe, RagdollWords& words) {
  words.def.seed = recipe.nextSeed();
  const Value human = nameValue("human");
  const Value* skeleton = reader.take("skeleton");
  words.skeleton = readSkeleton(skeleton ? *skeleton : human, reader.spot({"skeleton"}));
  physics::RagdollDef::fields(reader, words.def);
  checkFixed(reader, words);
}

void addFigure(TableReader& reader, Recipe& recipe, RagdollWords words, const std::string& name) {
  std::optional<render::Color> color;
  readColor(reader, color);
  const auto shared = std::make_shared<const RagdollWords>(std::move(words));
  recipe.add(reader, [=](Built& built) { build(built, *shared, name, color); });
}

void readRagdoll(TableReader& reader, Recipe& recipe) {
  const std::string name = readName(reader, physics::RagdollDef::kWord);
  RagdollWords words;
  readFigure(reader, recipe, words);
  const Value stand = nameValue("stand");
  const Value* pose = reader.take("pose");
  words.start = readTurns(pose ? *pose : stand, reader.spot({"pose"}), words.skeleton);
  readPoses(reader, words);
  readRepeat(reader, words.script);
  addFigure(reader, recipe, std::move(words), name);
}

}  // namespace scenes
