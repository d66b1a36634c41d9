// Which words of a scene file make an effect, and so take it out.
#include "scenes/read/effect_words.h"

#include <fmt/format.h>

#include <algorithm>

namespace scenes {
namespace {

// Keys of other words' tables that make constraints of a kind, and what each is set to without.
// A key that is not there is set where its default makes some.
struct Maker {
  const char *kind, *word, *key, *without;
  bool byDefault;
};
constexpr Maker kMakers[] = {
    {"drive", "ragdoll", "drive", "none", false},
    {"drive", "ragdoll", "poses", "none", false},
    {"motor", "hinge", "motor", "none", false},
    {"bend", "rope", "bending_stiffness", "0", false},
    {"bend", "cloth", "bending_stiffness", "0", false},
    {"drag", "rope", "drag", "none", false},
    {"panel_drag", "cloth", "drag", "none", false},
    {"rope_length", "rope", "total_length", "false", true},
    {"rope_length", "cloth", "total_length", "false", true},
    {"volume", "soft_body", "volume", "false", true},
};

const std::vector<Value>& elementsOf(const Value& tree, const std::string& word) {
  static const std::vector<Value> kNone;
  const Value* tables = tree.find(word);
  return tables == nullptr ? kNone : tables->items;
}

bool isConstraintWord(const std::string& kind) {
  const auto words = constraintWords();
  return std::any_of(words.begin(), words.end(), [&](const Word& w) { return kind == w.name; });
}

}  // namespace

std::string whyNone(const std::string& kind) {
  return isConstraintWord(kind) ? "no [[" + kind + "]]" : "no word asks for it";
}

void takeOut(const Survey& s, const Made& made, Effect& effect) {
  if (made.equalities == made.count) {
    effect.stays = "what it holds together would come apart";
    return;
  }
  if (s.find(effect.name) != nullptr) effect.without.push_back(effect.name + "=none");
  for (const Maker& maker : kMakers) {
    if (effect.name != maker.kind) continue;
    const std::vector<Value>& elements = elementsOf(s.tree, maker.word);
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (!maker.byDefault && elements[i].find(maker.key) == nullptr) continue;
      effect.without.push_back(fmt::format("{}.{}.{}={}", maker.word, i, maker.key, maker.without));
    }
  }
  if (effect.without.empty()) effect.stays = "[[" + made.word + "]] is made with it";
}

std::vector<std::string> withoutSurface(const Survey& s, const std::string& key) {
  std::vector<std::string> set{fmt::format("contact.{}=0", key)};
  for (const Member& word : s.tree.members) {
    for (std::size_t i = 0; i < word.value.items.size(); ++i) {
      if (word.value.items[i].find(key) == nullptr) continue;
      set.push_back(fmt::format("{}.{}.{}=0", word.key, i, key));
    }
  }
  return set;
}

}  // namespace scenes
