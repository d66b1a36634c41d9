// What `dbd words` lists is what the reader asks for: every word, each with its meaning.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "scenes/read/glossary.h"
#include "scenes/read/recipe.h"
#include "scenes/simulation.h"

namespace scenes {
namespace {

const Glossary& glossary() {
  static const Glossary shipped = shippedGlossary();
  return shipped;
}

const GlossaryKey* findKey(const std::string& table, const std::string& name) {
  const auto found = glossary().tables.find(table);
  if (found == glossary().tables.end()) return nullptr;
  const auto key = std::find_if(found->second.begin(), found->second.end(),
                                [&](const GlossaryKey& k) { return k.name == name; });
  return key == found->second.end() ? nullptr : &*key;
}

TEST(Glossary, EveryWordIsUsedInAShippedScene) {
  for (const auto& words : {bodyWords(), constraintWords()}) {
    for (const Word& word : words) EXPECT_TRUE(glossary().tables.contains(word.name)) << word.name;
  }
  for (const GlossaryKey& key : glossary().tables.at("")) {
    const bool isTable = findMeaning("", key.name)->type[0] == '[';
    EXPECT_EQ(glossary().tables.contains(key.name), isTable) << key.name;
  }
  for (const char* shape : {"point", "box", "sphere", "capsule", "cylinder", "convex", "plane"}) {
    EXPECT_TRUE(glossary().tables.contains(std::string("shape.") + shape)) << shape;
  }
}

TEST(Glossary, EveryKeyHasItsTypeAndMeaning) {
  for (const auto& [table, keys] : glossary().tables) {
    for (const GlossaryKey& key : keys) {
      EXPECT_FALSE(key.type.empty()) << table << "." << key.name;
      EXPECT_NE(findMeaning(table, key.name), nullptr) << table << "." << key.name;
    }
  }
}

TEST(Glossary, EveryMeaningIsOfAKeyThatTheReaderAsksFor) {
  std::set<const Meaning*> used;
  for (const auto& [table, keys] : glossary().tables) {
    for (const GlossaryKey& key : keys) used.insert(findMeaning(table, key.name));
  }
  for (const auto& meanings : {sharedMeanings(), ownMeanings()}) {
    for (const Meaning& meaning : meanings) EXPECT_TRUE(used.contains(&meaning)) << meaning.path;
  }
}

TEST(Glossary, TellsUnitsRangesAndDefaults) {
  const GlossaryKey* fps = findKey("simulation", "fps");
  ASSERT_NE(fps, nullptr);
  EXPECT_EQ(fps->type, "integer");
  EXPECT_EQ(fps->standard, "60");
  EXPECT_EQ(fps->range, "in [1, 1000000]");
  const GlossaryKey* radius = findKey("shape.sphere", "radius");
  ASSERT_NE(radius, nullptr);
  EXPECT_TRUE(radius->required);
  EXPECT_EQ(radius->unit, "m");
  EXPECT_EQ(radius->range, "> 0");
  EXPECT_EQ(findKey("simulation", "stepping")->type, "paper | static | bdf2 | symmetric");
  EXPECT_EQ(findKey("arch", "degrees")->standard, "180");
  EXPECT_EQ(findKey("body", "fixed")->standard, "");  // of a plane it is another
}

TEST(Glossary, TheExamplesOfWordsRun) {
  for (const char* name : {"joints", "forces", "repeat", "pictures"}) {
    Simulation simulation(readScene(libraryFolder() + "/../words/" + name + ".toml"));
    Checker checker(simulation.scene());
    for (int frame = 0; frame < simulation.scene().frameCount(); ++frame) {
      checker.observe(simulation);
      ASSERT_FALSE(simulation.advance().notFinite) << name;
    }
    for (const auto& verdict : checker.verdicts()) EXPECT_TRUE(verdict.holds) << verdict.text;
  }
}

}  // namespace
}  // namespace scenes
