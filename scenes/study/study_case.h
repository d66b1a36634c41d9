// A case of `dbd study accuracy`: which scene, which quantities against which reference, and which
// steps, substeps, iterations and methods are swept. Read from scenes/studies/accuracy/NAME.toml:
//
//   title = "Pendulum from horizontal"
//   about = "What the case shows, and what to look at."
//   scene = "../scenes/pendulum.toml"  # relative to this file; a bare name is one of the library
//   set = ["gravity.acceleration=[0,-9.81,0]"]   # overrides of the scene
//   duration = 10          # s; absent: the scene's
//   fps = 20               # samples per second
//   quick = true           # belongs to --quick, which thins the sweep out
//   trusted_until = 5      # s; past it the motion is chaotic: only `over` other than "each" counts
//   scale = 1.0            # what 100 % is, in the unit of the error
//   error = "max"          # of the norm over samples: max, rms, mean_square, mean, final
//   unit = "m"             # of the error, for axes; absent: the first quantity's
//   [[quantity]]           # the error of a sample is the norm over all quantities, weighted
//   metric = "x"           # any metric of scenes/metrics, or a vector: position, velocity,
//                          # angular_velocity, body_angular_velocity, orientation [rad between]
//   body = "bob"           # or a pattern; several bodies: the largest counts (means: their mean)
//   column = "x"           # of the reference's table; "-x": with the other sign
//   columns = ["x", "-z", "y"]   # of a vector, in the scene's order; orientation: w, x, y, z
//   law = [0, 0.5]         # or instead of a column: coefficients of a polynomial in t (s), of
//                          # every component; value = 3.1 is law = [3.1]
//   times = 1, plus = 0    # the reference is times * column + plus
//   weight = 1             # of its error in the norm
//   over = "each"          # each sample; or one number: last, max, min, mean, rms (unweighted)
//   from = 0, to = 10      # s, the samples that count
//   [reference]            # for quantities without `law`; absent: they are errors themselves
//   table = "S01_pendulum_A01.csv"    # of tests/reference, or a path from this file with a '/'
//   time = "t"             # its column of times
//   where = { zeta = 0.5 } # the rows that count
//   accuracy = 1e-12       # of the table, where known; or accuracy_column = "tip_err_est"
//   self = { set = ["simulation.stepping=symmetric"], steps = 1, substeps = 2000, iterations = 1 }
//                          # instead of a table: a run at least 10 times finer than the finest
//                          # point; one with half as many substeps estimates its error
//   [sweep]                # h = 1 / (fps * steps * substeps)
//   methods = ["paper", "bdf2"]   # of scenes/studies/methods.toml
//   steps = [1]            # World steps per sample; contacts are found once in each
//   substeps = [1, 2, 4, 8]
//   iterations = [1, 4]    # for methods that iterate; the others keep the scene's
//   accuracies = [1e-2, 1e-4]     # for methods that are asked for one, in place of all these
//   [sweep.paper]          # other values for one method, and overrides: set = [...]
//   substeps = [1, 16, 256]
//   [[published]]          # numbers of others, drawn as such
//   label = "RaiSim (SimBenchmark, i7-7700HQ)"
//   h = 0.01
//   error = 5.7e-4
//   seconds = 0.01         # wall time per simulated second, where published
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/study/study_methods.h"

namespace scenes {

struct StudyQuantity {
  enum class Over { kEach, kLast, kMax, kMin, kMean, kRms };
  std::string metric, body;
  std::vector<std::string> columns;  // one per component; empty: no column
  std::vector<double> law;           // empty: none
  double times = 1, plus = 0, weight = 1;
  Over over = Over::kEach;
  std::optional<double> from, to;  // s
};
std::span<const char* const> names(StudyQuantity::Over);

struct StudyGrid {  // what is swept for one method
  std::vector<int> steps{1}, substeps{1};
  std::vector<int> iterations{0};     // 0: the scene's own
  std::vector<double> accuracies{0};  // asked for; 0: none is
  std::vector<std::string> set;
};

struct StudyReference {
  std::string table;  // path; empty: none
  std::string time = "t";
  std::vector<std::pair<std::string, double>> where;
  std::optional<double> accuracy;
  std::string accuracyColumn;
  bool self = false;
  StudyGrid run;     // of `self`: one value each
  std::string text;  // of the table's file
};

struct StudyPublished {
  std::string label;
  double h = 0, error = 0;
  std::optional<double> seconds;
};

struct StudyCase {
  enum class Error { kMax, kRms, kMeanSquare, kMean, kFinal };
  std::string name, path, text;
  std::string title, about;
  std::string scenePath;         // what readScene takes
  std::vector<std::string> set;  // with duration and fps in it
  double duration = 10;
  int fps = 20;
  bool quick = false;
  std::optional<double> trustedUntil;
  double scale = 1;
  Error error = Error::kMax;
  std::string unit;
  std::vector<StudyQuantity> quantities;
  StudyReference reference;
  std::vector<StudyMethod> methods;  // in the order of the file
  std::vector<StudyGrid> grids;      // one per method
  std::vector<StudyPublished> published;

  int sampleCount() const;  // sample 0 is the start
};
std::span<const char* const> names(StudyCase::Error);

// A name of scenes/studies/accuracy, or a path. Throws InputError.
StudyCase readStudyCase(const std::string& study);
StudyCase parseStudyCase(const std::string& text, const std::string& path);
std::vector<std::string> studyCases();  // paths of those that are shipped, sorted

// The case's scene with its own overrides and these.
Scene studyScene(const StudyCase& study, std::span<const std::string> more);

}  // namespace scenes
