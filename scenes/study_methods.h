// The methods that studies compare, from scenes/studies/methods.toml: overrides of a scene, or an
// engine beside ours.
#pragma once

#include <string>
#include <vector>

namespace scenes {

struct StudyMethod {
  std::string name, title, about;
  std::vector<std::string> set;  // overrides that choose it
  std::string peer;              // "bullet", "ode": another engine; empty: ours
  std::string color;             // "#rrggbb"
  int marker = 7;                // gnuplot's point type
  bool iterates = true;          // whether the number of iterations matters
};

// Throws InputError. `methods` of the file that ships, in its order.
std::vector<StudyMethod> studyMethods();
std::vector<StudyMethod> parseStudyMethods(const std::string& text, const std::string& path);

}  // namespace scenes
