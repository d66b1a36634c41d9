// The methods that studies compare, from scenes/studies/methods.toml: overrides of a scene, or an
// engine beside ours.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace scenes {

struct StudyMethod {
  enum class Marker {
    kCircle,
    kSquare,
    kTriangle,
    kTriangleDown,
    kDiamond,
    kPentagon,
    kCircleOpen,
    kSquareOpen,
    kTriangleOpen,
    kTriangleDownOpen,
    kDiamondOpen,
    kPentagonOpen,
    kPlus,
    kCross,
    kStar
  };
  std::string name, title, about;
  std::vector<std::string> set;  // overrides that choose it
  std::string peer;              // "bullet", "ode": another engine; empty: ours
  std::string color;             // "#rrggbb"
  Marker marker = Marker::kCircle;
  bool iterates = true;  // whether the number of iterations matters
  bool asks = false;     // swept over the accuracy that it is asked for, and over nothing else
};
std::span<const char* const> names(StudyMethod::Marker);

// Of the file that ships, in its order. Throw InputError.
std::vector<StudyMethod> studyMethods();
std::vector<StudyMethod> parseStudyMethods(const std::string& text, const std::string& path);

}  // namespace scenes
