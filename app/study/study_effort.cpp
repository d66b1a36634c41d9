// How much is measured, and what a measurement depends on.
#include "app/study/study_effort.h"

#include <fmt/format.h>

#include "app/base/build_info.h"

namespace app {

StudyEffort effortOf(bool quick) {
  if (quick) return {0.06, 0.8, 7};
  return {};
}

std::string joinedLines(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, "\n"));
}

std::string studyInputs(const scenes::StudyCase& study) {
  static const std::string program = programHash();
  return hashText(program + study.text + scenes::studyScene(study, {}).text +
                  joinedLines(study.set) + study.reference.text);
}

}  // namespace app
