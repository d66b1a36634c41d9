// What one choice buys: the same cases with it and without it. Read from
// scenes/studies/options/NAME.toml:
//
//   title = "Inertia of a spinning body"
//   about = "What the choice is, and what to look at."
//   [with]
//   label = "M~"
//   set = ["simulation.inertia=spinning"]
//   [without]
//   label = "M"
//   set = ["simulation.inertia=plain"]
//   [[trial]]                 # a case, with one step
//   case = "top_box"          # of scenes/studies/accuracy, or a path from this file
//   set = ["simulation.method=direct"]   # in both
//   steps = 1
//   substeps = 8
//   iterations = 4            # absent: the scene's own
//   quick = true              # belongs to --quick
#pragma once

#include <string>
#include <vector>

#include "scenes/study/study_case.h"

namespace scenes {

struct StudyChoice {
  std::string label;
  std::vector<std::string> set;
};

struct StudyTrial {
  StudyCase study;  // its set has that of the trial
  int steps = 1, substeps = 1, iterations = 0;
  bool quick = false;
};

struct StudyOption {
  std::string name, path, text;
  std::string title, about;
  StudyChoice with, without;
  std::vector<StudyTrial> trials;
};

// A name of scenes/studies/options, or a path. Throws InputError.
StudyOption readStudyOption(const std::string& option);
StudyOption parseStudyOption(const std::string& text, const std::string& path);
std::vector<std::string> studyOptions();  // paths of those that are shipped, sorted

}  // namespace scenes
