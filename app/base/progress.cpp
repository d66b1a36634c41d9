// How far a long command is, on stderr: a bar on a terminal, lines elsewhere, or JSON.
#include "app/base/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/base/console.h"
#include "app/base/json.h"
#include "scenes/read/input_error.h"

namespace app {

namespace {

constexpr int kBarCells = 30;
constexpr double kBarPeriod = 0.1, kLinePeriod = 2;  // s

std::string clockText(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

ProgressMode parseProgressMode(const std::string& word) {
  if (word.empty()) return errorIsTerminal() ? ProgressMode::kBar : ProgressMode::kLines;
  if (word == "bar") return ProgressMode::kBar;
  if (word == "lines") return ProgressMode::kLines;
  if (word == "json") return ProgressMode::kJson;
  if (word == "none") return ProgressMode::kNone;
  throw scenes::InputError(fmt::format("--progress {}: expected bar, lines, json or none", word));
}

Progress::Progress(ProgressMode mode, std::string scene, std::string stage, int total, double work)
    : mode_(mode),
      scene_(std::move(scene)),
      stage_(std::move(stage)),
      total_(total),
      totalWork_(work) {}

Progress::~Progress() {
  if (onBarLine_) note("\n");
}

void Progress::advance(int by, double work) {
  if (mode_ == ProgressMode::kNone) return;
  const std::lock_guard lock(mutex_);
  done_ += by;
  doneWork_ += work;
  const double now = watch_.seconds();
  const double waited = now - reportedAt_;
  const bool tenth = 10 * (done_ - reportedDone_) >= total_;
  const bool due = mode_ == ProgressMode::kBar
                       ? waited >= kBarPeriod
                       : waited >= kLinePeriod || (tenth && waited >= kBarPeriod);
  if (due && done_ < total_) report(now);
}

void Progress::finish() {
  if (mode_ == ProgressMode::kNone || finished_) return;
  const std::lock_guard lock(mutex_);
  finished_ = true;
  report(watch_.seconds());
}

double Progress::remaining(double seconds) const {
  if (totalWork_ > 0) {
    return doneWork_ > 0 ? seconds / doneWork_ * std::max(0.0, totalWork_ - doneWork_) : 0;
  }
  return done_ > 0 ? seconds / done_ * (total_ - done_) : 0;
}

void Progress::report(double seconds) {
  reportedAt_ = seconds;
  reportedDone_ = done_;
  const double remaining = this->remaining(seconds);
  if (mode_ == ProgressMode::kBar) return drawBar(seconds, remaining);
  if (mode_ == ProgressMode::kJson) {
    const Json line = {{"scene", scene_}, {"stage", stage_},    {"done", done_},
                       {"total", total_}, {"seconds", seconds}, {"remaining", remaining}};
    return note(jsonText(line) + "\n");
  }
  const int percent = static_cast<int>(100LL * done_ / std::max(1, total_));
  note(fmt::format("{}: {} {}/{} ({} %), {} {}\n", scene_, stage_, done_, total_, percent,
                   finished_ ? "took" : "about",
                   clockText(finished_ ? seconds : remaining) + (finished_ ? "" : " left")));
}

void Progress::drawBar(double seconds, double remaining) {
  const int cells =
      static_cast<int>(static_cast<long long>(kBarCells) * done_ / std::max(1, total_));
  const std::string time =
      finished_ ? "took " + clockText(seconds) : clockText(remaining) + " left";
  note(fmt::format("\r{}: {} [{:-<{}}] {}/{} {}   ", scene_, stage_, std::string(cells, '#'),
                   kBarCells, done_, total_, time));
  onBarLine_ = !finished_;
  if (finished_) note("\n");
}

}  // namespace app
