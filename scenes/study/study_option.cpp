// Reads what a study of a choice consists of.
#include "scenes/study/study_option.h"

#include <filesystem>

#include "scenes/read/settings_reader.h"
#include "scenes/study/study_files.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

void readChoice(TableReader& root, const char* word, StudyChoice& choice) {
  if (!root.has(word)) root.failHere(std::string("expected a table [") + word + "]");
  readTable(root, word, [&](TableReader& reader) {
    reader(Field{"label", Unit::kNone, true}, choice.label);
    reader(Field{"set"}, choice.set);
  });
}

StudyTrial readTrial(TableReader& reader, const std::string& path) {
  constexpr int kMost = 1'000'000;
  StudyTrial trial;
  std::string word;
  std::vector<std::string> set;
  reader(Field{"case", Unit::kNone, true}, word);
  reader(Field{"set"}, set);
  reader(Field{"steps", Unit::kNone, false, 1, kMost}, trial.steps);
  reader(Field{"substeps", Unit::kNone, false, 1, kMost}, trial.substeps);
  reader(Field{"iterations", Unit::kNone, false, 1, kMost}, trial.iterations);
  reader(Field{"quick"}, trial.quick);
  try {
    trial.study = readStudyCase(besideStudy(word, path));
  } catch (const InputError& error) {
    reader.failAt("case", error.what());
  }
  trial.study.set.insert(trial.study.set.end(), set.begin(), set.end());
  trial.study.duration = studyScene(trial.study, {}).duration;
  return trial;
}

}  // namespace

StudyOption parseStudyOption(const std::string& text, const std::string& path) {
  const Value tree = parseToml(text, path);
  const Context context{path, nullptr};
  TableReader root(tree, "", context);
  StudyOption option;
  option.path = path;
  option.text = text;
  option.name = std::filesystem::path(path).stem().string();
  for (const char* word : {"title", "about", "with", "without", "trial"}) root.take(word);
  root.finish();
  root(Field{"title", Unit::kNone, true}, option.title);
  root(Field{"about"}, option.about);
  readChoice(root, "with", option.with);
  readChoice(root, "without", option.without);
  readTables(root, "trial",
             [&](TableReader& reader) { option.trials.push_back(readTrial(reader, path)); });
  if (option.trials.empty()) root.failHere("expected at least one [[trial]]");
  return option;
}

StudyOption readStudyOption(const std::string& option) {
  const std::string path = studyPath(option, "options");
  return parseStudyOption(readStudyText(path), path);
}

std::vector<std::string> studyOptions() { return studyFiles("options"); }

}  // namespace scenes
