// How far a long command is, on stderr: a bar on a terminal, lines elsewhere, or JSON.
#pragma once

#include <mutex>
#include <string>

#include "app/base/stopwatch.h"

namespace app {

enum class ProgressMode { kNone, kBar, kLines, kJson };

// "bar", "lines", "json" or "none"; empty: bar on a terminal, lines elsewhere. Throws InputError.
ProgressMode parseProgressMode(const std::string& word);

class Progress {
 public:
  // "pyramid: rendering", of `total` frames. `work`: what they take together, in any unit, where
  // they do not take the same time each.
  Progress(ProgressMode mode, std::string scene, std::string stage, int total, double work = 0);
  ~Progress();  // ends the bar's line

  void advance(int by = 1, double work = 0);  // from any thread
  void finish();                              // the last report

 private:
  void report(double seconds);
  void drawBar(double seconds, double remaining);
  double remaining(double seconds) const;

  const ProgressMode mode_;
  const std::string scene_, stage_;
  const int total_;
  const double totalWork_;
  std::mutex mutex_;
  Stopwatch watch_;
  int done_ = 0, reportedDone_ = 0;
  double doneWork_ = 0;
  double reportedAt_ = 0;
  bool onBarLine_ = false, finished_ = false;
};

}  // namespace app
