// What a run that was stopped goes on from: beside the frames of its motion so far (path +
// ".begun") all that the next one depends on, in path + ".state". Written whole or not at all, and
// gone when the motion is whole.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "app/base/stopwatch.h"
#include "app/run/run_record.h"
#include "physics/base/archive.h"

namespace app {

class Checkpoint {
 public:
  using Members = std::function<void(physics::Archive&)>;

  // `run`: what the motion depends on, runOf().
  Checkpoint(const std::filesystem::path& motion, Json run);
  static Json runOf(const RunRecord& record, int frames, int keeps);

  // Where an earlier run of the same left one, to be read from; else there is nothing to go on
  // from, or it was to keep other frames. Throws InputError where it is of a run that differs.
  std::optional<physics::Archive> open();

  void write(const Members& members);
  void pass(const Members& members);  // after a frame: writes where it is time
  void end(const Members& members);   // of a run that is stopped
  void remove();

  double seconds() const { return seconds_; }  // that all writing has taken

 private:
  [[noreturn]] void refuse(const Json& was) const;

  std::filesystem::path file_;
  Json run_;
  std::string bytes_;
  Stopwatch sinceLast_;
  double cost_, seconds_ = 0;
};

}  // namespace app
