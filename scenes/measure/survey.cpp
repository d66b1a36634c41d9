// Builds a scene's world table by table and looks what each has added.
#include "scenes/measure/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "physics/constraints/constraint_item.h"
#include "physics/motion/free_motion.h"

namespace scenes {
namespace {

using physics::BodyId;
using physics::Motion;

void add(Made& made, std::int64_t now, const std::string& word, const Place& place) {
  if (made.count == 0 && now > 0) {
    made.word = word;
    made.place = place;
  }
  made.count = now;
}

bool isDynamic(const physics::Bodies& bodies, BodyId b) {
  return bodies.motion[b] == Motion::kDynamic;
}

bool isShaped(const physics::Bodies& bodies, BodyId b) {
  return !std::holds_alternative<physics::PointShape>(bodies.shape[b]);
}

// How many of each kind there are, and their rows.
std::map<std::string, Made> countKinds(const physics::World& world) {
  std::map<std::string, Made> kinds;
  for (const physics::ConstraintItem& constraint : world.constraints()) {
    Made& made = kinds[constraint.kind];
    ++made.count;
    std::visit(
        [&](const auto& item) {
          made.rows += std::decay_t<decltype(item)>::kRows;
          made.equalities += physics::isEquality(item) ? 1 : 0;
        },
        constraint.item);
  }
  return kinds;
}

}  // namespace

// Tables of one word follow each other: it is enough to look after the last of them.
Survey::Survey(const Scene& s) : scene(s), tree(s.content->tree), built(s.settings) {
  const auto& steps = scene.content->steps;
  const auto& origins = scene.content->origins;
  Place first;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i == 0 || origins[i].word != origins[i - 1].word) first = origins[i].place;
    steps[i](built);
    if (i + 1 == steps.size() || origins[i + 1].word != origins[i].word) {
      note(origins[i].word, first);
    }
  }
  countPairs();
}

void Survey::note(const std::string& word, const Place& place) {
  for (const auto& [kind, now] : countKinds(built.world)) {
    Made& made = kinds[kind];
    add(made, now.count, word, place);
    made.rows = now.rows;
    made.equalities = now.equalities;
  }
  const physics::Bodies& b = built.world.bodies();
  std::int64_t dynamic = 0, turns = 0, softPoints = 0;
  for (BodyId i = 1; i < b.size(); ++i) {
    dynamic += isDynamic(b, i) ? 1 : 0;
    turns += b.inverseInertia[i].isZero(0) ? 0 : 1;
    softPoints += b.isSoft[i] ? 1 : 0;
  }
  const auto uneven = std::count_if(b.inertia.begin(), b.inertia.end(), [](const auto& inertia) {
    return !physics::isIsotropic(inertia);
  });
  add(bodies, dynamic, word, place);
  add(points, dynamic - turns, word, place);
  add(turning, turns, word, place);
  add(gyroscopic, uneven, word, place);
  add(soft, softPoints, word, place);
  add(arms, static_cast<std::int64_t>(built.world.arms().size()), word, place);
}

// Two static bodies never touch, nor do those that are ignored.
void Survey::countPairs() {
  const physics::Bodies& b = built.world.bodies();
  std::int64_t moving = 0, rough = 0, roughMoving = 0;
  for (BodyId i = 1; i < b.size(); ++i) {
    if (!isShaped(b, i)) continue;
    const bool isRough = b.friction[i].staticCoefficient > 0;
    ++shaped;
    moving += isDynamic(b, i) ? 1 : 0;
    rough += isRough ? 1 : 0;
    roughMoving += isRough && isDynamic(b, i) ? 1 : 0;
  }
  pairs = moving * (shaped - moving) + moving * (moving - 1) / 2;
  for (const auto& [i, j] : built.world.ignoredPairs()) {
    const bool counted = isShaped(b, i) && isShaped(b, j) && i != physics::kWorldBody &&
                         (isDynamic(b, i) || isDynamic(b, j));
    pairs -= counted ? 1 : 0;
  }
  const auto& contact = scene.settings.contact;
  const bool softRough = soft.count > 0 && contact && contact->friction.staticCoefficient > 0;
  frictional = (roughMoving > 0 && rough > 1) || softRough;
}

const Value* Survey::find(const std::string& key) const {
  const Value* at = &tree;
  for (std::size_t from = 0; at != nullptr && from <= key.size();) {
    const std::size_t dot = std::min(key.find('.', from), key.size());
    at = at->find(key.substr(from, dot - from));
    from = dot + 1;
  }
  return at;
}

std::string Survey::text(const Place& place, const std::string& what) const {
  if (!place.setting.empty()) return place.setting;
  const std::string& path = place.file.empty() ? scene.path : place.file;
  const std::string file = std::filesystem::path(path).filename().string();
  return fmt::format("{}:{}: {}", file, place.line, what);
}

std::string Survey::place(const std::string& key) const {
  const Value* value = find(key);
  if (value == nullptr) return "";
  const bool isTable = value->isTable() && key.find('.') == std::string::npos;
  return text(value->place, isTable ? "[" + key + "]" : key);
}

std::string Survey::place(const Made& made) const {
  return text(made.place, "[[" + made.word + "]]");
}

}  // namespace scenes
