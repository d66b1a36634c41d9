// A case of `dbd study stability`: a scene file with two or three more tables. How it is solved is
// not its own choice but that of its family, in scenes/studies/stability_families.toml, so that no
// case is tuned. Any command runs such a file; a case is read from
// scenes/studies/stability/NAME.toml:
//
//   [stability]
//   family = "chains"      # whose settings it has; [simulation] of the case may say fps and seed
//   about = "What is hard, and what the criterion is."   # the criterion is the scene's [[expect]]
//   methods = ["paper", "xpbd"]   # of scenes/studies/methods.toml, beside the family's own
//                                 # settings; absent: those of the family
//   about_settings = ["substeps"] # settings of the family that this case is about and says itself
//   quick = true                  # belongs to --quick
//   [severity]             # how far it can be pushed; the stated level is what the file says
//   set = "chain.chain.end.mass"  # as in --set; or several, set to the same value
//   from = 1               # where the map begins; the stated level lies between the two
//   to = 1e6               # the hardest; smaller than `from` where less is harder
//   scale = "log"          # or "linear", "integer"
//   label = "mass of the end / mass of a link"
//   unit = "kg"
//   duration = 5           # s, of the runs that search; absent: the scene's
//   [[variant]]            # one more case: the same file with overrides, `--set
//   stability.variant=NAME` name = "falls" about = "What differs." set =
//   ["arch.arch.thickness=0.1"]
//   [[variant.expect]]     # in place of the file's own
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/read/value.h"
#include "scenes/scene.h"
#include "scenes/study/study_methods.h"

namespace scenes {

struct StabilitySeverity {
  enum class Scale { kLog, kLinear, kInteger };
  std::vector<std::string> keys;
  double from = 0, to = 0, stated = 0;
  Scale scale = Scale::kLog;
  std::string label, unit;
  std::optional<double> duration;  // s

  double placeOf(double level) const;  // 0 at `from`, 1 at `to`
  double levelAt(double place) const;  // its inverse, to three digits; whole where integer
  std::vector<std::string> overrides(double level) const;
};
std::span<const char* const> names(StabilitySeverity::Scale);

struct StabilityVariant {
  std::string name, about;
  std::vector<std::string> set;
};

struct StabilityFamily {
  std::string name, title, about;
  std::vector<std::string> methods;
  Value settings;  // tables of a scene file
};

struct StabilityCase {
  std::string name;     // "arch", "arch.falls"
  std::string variant;  // empty: the file as it is
  std::string path, text;
  std::string title, about;
  StabilityFamily family;
  std::vector<StudyMethod> methods;  // beside the family's own settings
  bool quick = false;
  double duration = 0;                        // s
  std::optional<StabilitySeverity> severity;  // of the file itself, not of its variants
};

// What a file holds: itself, then its variants. `word` is a name of scenes/studies/stability or a
// path, and with ".VARIANT" after either one variant alone. Throws InputError.
std::vector<StabilityCase> readStabilityCases(const std::string& word);
std::vector<std::string> stabilityFiles();  // paths of those that are shipped, sorted

// The case's scene with these overrides as well.
Scene stabilityScene(const StabilityCase& study, std::span<const std::string> more);

// Of the file that ships, in its order.
std::vector<StabilityFamily> stabilityFamilies();

// Where the tree has a table [stability]: the settings of its family and the chosen variant are
// put into it and the tables of the study are taken out. Gives the overrides that are left.
std::vector<std::string> applyStability(Value& tree, const std::string& path,
                                        std::span<const std::string> overrides);

}  // namespace scenes
