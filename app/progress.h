// How far a long command is, on stderr: a bar on a terminal, lines elsewhere, or JSON.
#pragma once

#include <mutex>
#include <string>

#include "app/stopwatch.h"

namespace app {

enum class ProgressMode { kNone, kBar, kLines, kJson };

// "bar", "lines", "json" or "none"; empty: bar on a terminal, lines elsewhere. Throws InputError.
ProgressMode parseProgressMode(const std::string& word);

class Progress {
 public:
  // "pyramid: rendering", of `total` frames.
  Progress(ProgressMode mode, std::string scene, std::string stage, int total);
  ~Progress();  // ends the bar's line

  void advance(int by = 1);  // from any thread
  void finish();             // the last report

 private:
  void report(double seconds);
  void drawBar(double seconds, double remaining);

  const ProgressMode mode_;
  const std::string scene_, stage_;
  const int total_;
  std::mutex mutex_;
  Stopwatch watch_;
  int done_ = 0, reportedDone_ = 0;
  double reportedAt_ = 0;
  bool onBarLine_ = false, finished_ = false;
};

}  // namespace app
