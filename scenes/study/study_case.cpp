// From the text of a study's case to its checked parts.
#include "scenes/study/study_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/read/settings_reader.h"
#include "scenes/study/study_files.h"
#include "scenes/study/study_reader.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

constexpr double kFineness = 10;  // how much finer than any point a reference run must be

void readHead(TableReader& root, StudyCase& study) {
  root(Field{"title", Unit::kNone, true}, study.title);
  root(Field{"about"}, study.about);
  root(Field{"fps", Unit::kNone, false, 1, 1e6}, study.fps);
  root(Field{"quick"}, study.quick);
  root(Field{"trusted_until", Unit::kNone, false, kPositive}, study.trustedUntil);
  root(Field{"scale", Unit::kNone, false, kPositive}, study.scale);
  root(Field{"error"}, study.error);
  root(Field{"unit"}, study.unit);
  std::string scene;
  root(Field{"scene", Unit::kNone, true}, scene);
  study.scenePath = besideStudy(scene, study.path);
  root(Field{"set"}, study.set);
  study.set.push_back(fmt::format("simulation.fps={}", study.fps));
  if (root.has("duration")) {
    root(Field{"duration", Unit::kNone, false, kPositive}, study.duration);
    study.set.push_back(fmt::format("duration={:.17g}", study.duration));
  }
}

Scene readOwnScene(TableReader& root, StudyCase& study) {
  try {
    Scene scene = studyScene(study, {});
    study.duration = scene.duration;
    return scene;
  } catch (const InputError& error) {
    root.failAt("scene", error.what());
  }
}

void readGrid(TableReader& reader, StudyGrid& grid) {
  constexpr int kMost = 1'000'000;
  const auto list = [&](const char* key, auto& values, double least, double most) {
    reader(Field{key, Unit::kNone, false, least, most}, values);
    if (reader.has(key) && values.empty()) reader.failAt(key, "expected at least one");
  };
  list("steps", grid.steps, 1, kMost);
  list("substeps", grid.substeps, 1, kMost);
  list("iterations", grid.iterations, 1, kMost);
  list("accuracies", grid.accuracies, 1e-12, 0.5);  // as simulation.accuracy
}

// What a method takes of the sweep that all share.
StudyGrid gridOf(const StudyMethod& method, const StudyGrid& common) {
  StudyGrid grid;
  if (method.asks) {
    grid.accuracies = common.accuracies;
    return grid;
  }
  grid = common;
  grid.accuracies = {0};
  if (!method.iterates) grid.iterations = {0};
  return grid;
}

void readOwnGrid(TableReader& own, const StudyMethod& method, StudyGrid& grid) {
  if (!method.asks && own.has("accuracies")) {
    own.failAt("accuracies", fmt::format("'{}' is not asked for an accuracy", method.name));
  }
  for (const char* key : {"steps", "substeps", "iterations"}) {
    if (!method.asks || !own.has(key)) continue;
    own.failAt(key, fmt::format("'{}' is swept over accuracies alone", method.name));
  }
  readGrid(own, grid);
  own(Field{"set"}, grid.set);
}

const StudyMethod& findMethod(const TableReader& sweep, const std::vector<StudyMethod>& known,
                              const std::string& name) {
  std::vector<std::string> words;
  for (const StudyMethod& method : known) {
    if (method.name == name) return method;
    words.push_back(method.name);
  }
  sweep.failAt("methods", fmt::format("no method '{}'{}", name, didYouMean(name, words)));
}

void readSweep(TableReader& sweep, StudyCase& study) {
  StudyGrid common;
  common.accuracies = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
  readGrid(sweep, common);
  std::vector<std::string> wanted;
  sweep(Field{"methods", Unit::kNone, true}, wanted);
  if (wanted.empty()) sweep.failAt("methods", "expected at least one");
  const std::vector<StudyMethod> known = studyMethods();
  for (const std::string& name : wanted) {
    const StudyMethod& method = findMethod(sweep, known, name);
    StudyGrid grid = gridOf(method, common);
    readTable(sweep, name.c_str(), [&](TableReader& own) { readOwnGrid(own, method, grid); });
    study.methods.push_back(method);
    study.grids.push_back(grid);
  }
}

void readPublished(TableReader& reader, StudyCase& study) {
  StudyPublished published;
  reader(Field{"label", Unit::kNone, true}, published.label);
  reader(Field{"h", Unit::kNone, true, kPositive}, published.h);
  reader(Field{"error", Unit::kNone, true, 0}, published.error);
  reader(Field{"seconds", Unit::kNone, false, kPositive}, published.seconds);
  study.published.push_back(published);
}

// A reference run has to be finer than what it judges.
void checkFineness(const TableReader& root, const StudyCase& study) {
  if (!study.reference.self) return;
  const auto product = [](int a, int b) { return static_cast<double>(a) * b; };
  double finest = 1;
  for (const StudyGrid& grid : study.grids) {
    finest =
        std::max(finest, product(*std::max_element(grid.steps.begin(), grid.steps.end()),
                                 *std::max_element(grid.substeps.begin(), grid.substeps.end())));
  }
  const StudyGrid& run = study.reference.run;
  const double own = product(run.steps[0], run.substeps[0]);
  if (own >= kFineness * finest) return;
  root.failAt("reference",
              fmt::format("self: expected steps * substeps >= {:.0f}, {:g} times those of the "
                          "finest point, got {:.0f}",
                          kFineness * finest, kFineness, own));
}

}  // namespace

std::span<const char* const> names(StudyCase::Error) {
  static constexpr const char* kNames[] = {"max", "rms", "mean_square", "mean", "final"};
  return kNames;
}

int StudyCase::sampleCount() const { return static_cast<int>(std::lround(duration * fps)) + 1; }

Scene studyScene(const StudyCase& study, std::span<const std::string> more) {
  std::vector<std::string> set = study.set;
  set.insert(set.end(), more.begin(), more.end());
  return readScene(study.scenePath, set);
}

StudyCase parseStudyCase(const std::string& text, const std::string& path) {
  const Value tree = parseToml(text, path);
  StudyCase study;
  study.path = path;
  study.text = text;
  study.name = std::filesystem::path(path).stem().string();
  const Context context{path, nullptr};
  TableReader root(tree, "", context);
  for (const char* word :
       {"title", "about", "scene", "set", "duration", "fps", "quick", "trusted_until", "scale",
        "error", "unit", "quantity", "reference", "sweep", "published"}) {
    root.take(word);
  }
  root.finish();
  readHead(root, study);
  const Scene scene = readOwnScene(root, study);
  readReference(root, study);
  readQuantities(root, scene, study);
  if (!root.has("sweep")) root.failHere("expected a table [sweep]");
  readTable(root, "sweep", [&](TableReader& sweep) { readSweep(sweep, study); });
  checkFineness(root, study);
  readTables(root, "published", [&](TableReader& reader) { readPublished(reader, study); });
  return study;
}

StudyCase readStudyCase(const std::string& study) {
  const std::string path = studyPath(study, "accuracy");
  return parseStudyCase(readStudyText(path), path);
}

std::vector<std::string> studyCases() { return studyFiles("accuracy"); }

}  // namespace scenes
