// A scene file from its text to a checked Scene: settings, bodies, constraints, camera and
// expectations.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "scenes/measure/metrics.h"
#include "scenes/models/read_model.h"
#include "scenes/read/expand.h"
#include "scenes/read/recipe.h"
#include "scenes/read/settings_reader.h"
#include "scenes/read/write_scene.h"
#include "scenes/study/stability_case.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

constexpr int kMostFrames = 10'000'000;

void readHead(TableReader& root, Scene& scene) {
  root(Field{"title"}, scene.title);
  root(Field{"description"}, scene.description);
  root(Field{"duration", Unit::kNone, false, kPositive}, scene.duration);
  if (scene.title.empty()) scene.title = scene.name;
}

// Every word there is, so that a misspelt table is reported before what it lacks is missed.
void checkWords(TableReader& root) {
  for (const char* word : {"title", "description", "duration", "simulation", "gravity", "contact",
                           "sleep", "camera", "film", "light", "background", "label", "overlays",
                           "golden", "expect", "include", "parameters", "repeat"}) {
    root.take(word);
  }
  for (const Word& word : bodyWords()) root.take(word.name);
  for (const Word& word : constraintWords()) root.take(word.name);
  root.finish();
}

void checkDuration(const TableReader& root, const Scene& scene) {
  const double frames = scene.duration * scene.fps;
  if (frames <= kMostFrames) return;
  fail(root.context(), root.table().find("duration")->place,
       fmt::format("duration: expected at most {} frames, got {:.0f}", kMostFrames, frames));
}

// Names are of bodies, which the recipe knows, or one to each table of a word, for --set.
void readWords(TableReader& root, Recipe& recipe, std::span<const Word> words) {
  for (const Word& word : words) {
    std::set<std::string> names;
    readTables(root, word.name, [&](TableReader& reader) {
      word.read(reader, recipe);
      const Value* name = reader.table().find("name");
      if (name == nullptr || names.insert(name->text).second) return;
      reader.failAt(
          "name", fmt::format("expected a new name, '{}' is a {} already", name->text, word.name));
    });
  }
}

void checkExpectedBodies(const TableReader& root, const Scene& scene, const Built& trial) {
  const Context& context = root.context();
  const auto known = [&](const std::string& pattern) {
    if (trial.ids.contains(pattern)) return true;
    for (const std::string& name : trial.names) {
      if (matches(pattern, name)) return true;
    }
    return false;
  };
  for (const Expectation& expectation : scene.expectations) {
    if (expectation.body.empty() || known(expectation.body)) continue;
    fail(context, {expectation.line, expectation.column, {}, expectation.file},
         fmt::format("expect: no body '{}'{}", expectation.body,
                     didYouMean(expectation.body, trial.names)));
  }
  const auto requireKnown = [&](const Value& place, const char* key, const std::string& pattern) {
    if (known(pattern)) return;
    fail(context, place.place,
         fmt::format("{}: no body '{}'{}", key, pattern, didYouMean(pattern, trial.names)));
  };
  const Value* camera = root.table().find("camera");
  for (const auto& [key, patterns] :
       {std::pair("fit", &scene.camera.fit), std::pair("follow", &scene.camera.follow)}) {
    const Value* value = camera == nullptr ? nullptr : camera->find(key);
    if (value == nullptr) continue;
    for (const std::string& pattern : patterns->any) {
      requireKnown(*value, key == std::string("fit") ? "camera.fit" : "camera.follow", pattern);
    }
  }
  for (std::size_t i = 0; i < scene.labels.size(); ++i) {
    const Value* body = root.table().find("label")->items[i].find("body");
    if (body != nullptr) requireKnown(*body, "label.body", scene.labels[i].body);
  }
}

// The words that switch something on, in the order of the file.
std::vector<std::string> effectsOf(const Value& root, const Scene& scene, const Built& built) {
  std::vector<std::string> effects;
  for (const Member& member : root.members) {
    const std::string& word = member.key;
    const auto isIt = [&](const Word& known) { return word == known.name; };
    const auto bodies = bodyWords();
    const auto constraints = constraintWords();
    const bool generator = word != "body" && std::any_of(bodies.begin(), bodies.end(), isIt);
    const bool constraint = std::any_of(constraints.begin(), constraints.end(), isIt);
    const bool takesOut = word == "no_contact";
    if (word == "gravity" || generator || (constraint && !takesOut)) effects.push_back(word);
  }
  if (scene.settings.contact) effects.emplace_back("contact");
  if (scene.settings.contact && built.world.bodies().mostRestitution > 0) {
    effects.emplace_back("restitution");
  }
  if (scene.settings.sleep) effects.emplace_back("sleep");
  return effects;
}

physics::Settings checkedSettings(const TableReader& root, const physics::Settings& settings) {
  try {
    const physics::World trial(settings);
  } catch (const std::invalid_argument& error) {
    root.failAt("simulation", error.what());
  }
  return settings;
}

// keyframe=NAME, of a model: none of the words that it becomes.
std::string takeKeyframe(std::vector<std::string>& settings) {
  const std::string key = "keyframe=";
  std::string name;
  std::erase_if(settings, [&](const std::string& setting) {
    if (!setting.starts_with(key)) return false;
    name = setting.substr(key.size());
    return true;
  });
  return name;
}

// The words of a scene file, or those that a model becomes, with what it includes.
Value readTree(const std::string& text, const Context& context, const std::string& keyframe,
               Scene& scene) {
  Value tree;
  if (isModel(text, context.path)) {
    tree = readModel(text, context.path, scene.told, keyframe);
    // What it is made of is in other files as well.
    scene.text = tomlOf(tree, std::filesystem::path(context.path).parent_path().string());
  } else {
    tree = parseToml(text, context.path);
    scene.text = text;
  }
  scene.text += includeFiles(tree, context, scene.told);
  return tree;
}

}  // namespace

int Scene::frameCount() const { return static_cast<int>(std::lround(duration * fps)) + 1; }

Scene parseScene(const std::string& text, const std::string& path,
                 std::span<const std::string> overrides, Glossary* glossary) {
  Context context{path, nullptr, glossary};
  Scene scene;
  std::vector<std::string> settings(overrides.begin(), overrides.end());
  const std::string keyframe = isModel(text, path) ? takeKeyframe(settings) : "";
  Value tree = readTree(text, context, keyframe, scene);
  const auto others = setParameters(tree, applyStability(tree, path, settings));
  expand(tree, context);
  for (const std::string& setting : others) applyOverride(tree, setting);
  scene.name = std::filesystem::path(path).stem().string();
  scene.path = path;
  scene.overrides.assign(overrides.begin(), overrides.end());
  TableReader root(tree, "", context);
  checkWords(root);
  readHead(root, scene);
  readSettings(root, scene);
  checkDuration(root, scene);
  readPresentation(root, scene);
  scene.settings = checkedSettings(root, scene.settings);
  Recipe recipe(scene, context);
  readWords(root, recipe, bodyWords());
  readWords(root, recipe, constraintWords());
  checkExpectedBodies(root, scene, recipe.trial());
  scene.effects = effectsOf(tree, scene, recipe.trial());
  Scene::Content content = recipe.take();
  content.tree = std::move(tree);
  scene.content = std::make_shared<const Scene::Content>(std::move(content));
  return scene;
}

}  // namespace scenes
