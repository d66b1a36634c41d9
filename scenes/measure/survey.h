// What a scene's tables have made: how many of each kind, and by which table first.
#pragma once

#include <map>
#include <string>

#include "scenes/read/recipe.h"

namespace scenes {

struct Made {
  std::int64_t count = 0, rows = 0;
  std::int64_t equalities = 0;  // of them: they hold something together
  std::string word;             // of the table that made the first
  Place place;
};

struct Survey {
  explicit Survey(const Scene& scene);

  const Scene& scene;
  const Value& tree;  // what the file and the overrides say
  Built built;
  std::map<std::string, Made> kinds;         // by the kind's word
  Made bodies, points, turning, gyroscopic;  // of those that can move; `points` do not turn
  Made soft, arms;                           // points of soft surfaces; arms
  std::int64_t shaped = 0;                   // bodies that something could touch
  std::int64_t pairs = 0;                    // of bodies that could touch each other, ever
  bool frictional = false;                   // some pair has friction

  // "chain.toml:14: [gravity]". Empty where the file has no such key; keys as of --set.
  std::string place(const std::string& key) const;
  std::string place(const Made& made) const;
  const Value* find(const std::string& key) const;  // null where absent

 private:
  void note(const std::string& word, const Place& place);
  void countPairs();
  std::string text(const Place& place, const std::string& what) const;
};

}  // namespace scenes
