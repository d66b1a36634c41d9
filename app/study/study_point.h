// One point of a study: a case, a method and a step, with what it cost and how wrong it was; and
// the file points.csv that keeps them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/study/study_trace.h"

namespace app {

struct StudyKey {
  std::string study, method;
  int steps = 1, substeps = 1;
  int iterations = 0;   // 0: the scene's own
  double accuracy = 0;  // asked for, relative; 0: none is, the steps say how fine

  bool operator==(const StudyKey&) const = default;
  double work() const;       // sweeps per sample, as far as the key says
  std::string text() const;  // "4 x 20 substeps, 8 iterations", "accuracy 1e-3"
};

struct StudyPoint {
  enum class Status {
    kOk,
    kNotFinite,  // a number was not finite
    kExploded,   // the error exceeds 1000 times the case's scale
    kTooSlow,    // given up while being measured
    kRefused,    // the method cannot do this scene
    kSkipped,    // not measured: it would have taken too long
  };
  StudyKey key;
  double h = 0;  // s; 0: the method chooses its steps
  Status status = Status::kOk;
  scenes::StudyErrors errors;
  scenes::StudyWorst worst;
  // All per simulated second. Wall time: the least and the median of the repeats, and how much the
  // slowest took beyond the least, relative.
  double wall = 0, wallMedian = 0, wallSpread = 0, processor = 0;
  int repeats = 0;
  double load = 0;         // the machine's average over the last minute
  double evaluations = 0;  // of constraints
  double sweeps = 0;
  double restarts = 0, fallbacks = 0;  // of second-order steps
  double estimate = 0;                 // of the error, by the method that was asked; relative
  std::string inputs;                  // hash of all that the numbers depend on
  std::string message;                 // why it is not ok

  // What is compared: the wall time, or the processor's time where other programs took the
  // processor meanwhile.
  double cost() const;
  bool isOk() const { return status == Status::kOk; }
  bool isFailure() const;  // it ran, and its result is worthless
};

std::string accuracyText(double accuracy);  // "1e-3"
const char* statusName(StudyPoint::Status status);

// points.csv: a line for the heads, then one for each point. Numbers carry 9 digits.
std::string pointHeads();
std::string pointRow(const StudyPoint& point);
// Rows that are torn or not understood are left out.
std::vector<StudyPoint> parsePoints(const std::string& text);

// The points of an output folder: what was measured earlier, and each new one as it comes.
class PointStore {
 public:
  // `keep`: what the file holds stays known.
  PointStore(std::filesystem::path path, bool keep);

  // The point as it was measured from the same inputs; null: it was not, or was skipped.
  const StudyPoint* find(const StudyKey& key, const std::string& inputs) const;
  void append(const StudyPoint& point);  // to the file, at once
  void rewrite(const std::vector<StudyPoint>& points);
  const std::vector<StudyPoint>& earlier() const { return earlier_; }

 private:
  std::filesystem::path path_;
  std::vector<StudyPoint> earlier_;
};

}  // namespace app
