// The loop over cases and points.
#include "app/study/study_accuracy.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/build_info.h"
#include "app/base/output_file.h"
#include "app/study/study_reference.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using scenes::StudyCase;
using Status = StudyPoint::Status;

const fs::path& madeFolder(const fs::path& folder) {
  makeFolder(folder);
  return folder;
}

// How long the run of `key` will take [s], from those of the same method and as many iterations
// that were measured.
double expectedSeconds(const StudyResults& results, const StudyKey& key) {
  double seconds = 0;
  for (const StudyPoint& point : results.points) {
    const bool same = point.key.method == key.method && point.key.iterations == key.iterations;
    if (!same || !(point.isOk() || point.isFailure())) continue;
    seconds = point.cost() * results.study.duration * key.work() / point.key.work();
  }
  return seconds;
}

}  // namespace

AccuracyStudy::Inputs AccuracyStudy::inputsOf(const StudyCase& study) {
  Inputs inputs{studyInputs(study), {}};
  for (const scenes::StudyMethod& method : study.methods) {
    inputs.methods.push_back(hashText(inputs.reference + joinedLines(method.set) + method.peer));
  }
  return inputs;
}

AccuracyStudy::AccuracyStudy(std::vector<StudyCase> cases, const fs::path& folder, bool quick,
                             bool keep, ProgressMode progress)
    : cases_(std::move(cases)),
      folder_(madeFolder(folder)),
      quick_(quick),
      effort_(effortOf(quick)),
      store_(folder_ / "points.csv", keep) {
  int total = 0;
  double work = 0;
  for (const StudyCase& study : cases_) {
    plans_.push_back(planPoints(study, quick_));
    results_.push_back({study, {}, {}});
    inputs_.push_back(inputsOf(study));
    total += static_cast<int>(plans_.back().size());
    for (const PlannedPoint& planned : plans_.back()) work += workOf(plans_.size() - 1, planned);
  }
  progress_.emplace(progress, "accuracy", "measuring", total, work);
}

// A guess at the seconds that a point will take; nothing where it is known. For the progress alone.
double AccuracyStudy::workOf(std::size_t index, const PlannedPoint& planned) const {
  constexpr double kSweep = 3e-6;  // s, of a small scene
  const auto m = static_cast<std::size_t>(planned.method);
  if (store_.find(planned.key, inputs_[index].methods[m]) != nullptr) return 0;
  const double run = kSweep * planned.key.work() * cases_[index].sampleCount();
  return std::clamp(run, effort_.repeat, effort_.longest);
}

std::optional<StudyPoint> AccuracyStudy::pointFor(const PlannedPoint& planned,
                                                  StudyResults& results,
                                                  const scenes::StudyTrace& truth,
                                                  const std::string& inputs) {
  if (const StudyPoint* point = store_.find(planned.key, inputs)) {
    ++reused_;
    return *point;
  }
  const auto m = static_cast<std::size_t>(planned.method);
  const double expected = expectedSeconds(results, planned.key);
  std::optional<StudyPoint> point;
  if (expected > effort_.longest) {
    point.emplace();
    point->key = planned.key;
    point->h = stepOf(results.study, planned.key);
    point->status = Status::kSkipped;
    point->message = fmt::format("about {:.0f} s", expected);
  } else {
    point = measurePoint(results.study, results.study.methods[m], results.study.grids[m],
                         planned.key, truth, effort_);
  }
  if (!point) return std::nullopt;
  point->inputs = inputs;
  store_.append(*point);
  return point;
}

StudyEnds AccuracyStudy::measurePoints(std::size_t index, const scenes::StudyTrace& truth) {
  StudyResults& results = results_[index];
  bool refused = false;
  int method = -1;
  for (const PlannedPoint& planned : plans_[index]) {
    if (planned.method != method) refused = false;
    method = planned.method;
    if (!refused) {  // what a method cannot do once it cannot do with other steps
      const std::optional<StudyPoint> point = pointFor(
          planned, results, truth, inputs_[index].methods[static_cast<std::size_t>(method)]);
      if (!point) return {true, ""};
      results.points.push_back(*point);
      refused = point->status == Status::kRefused;
    }
    progress_->advance(1, workOf(index, planned));
  }
  return {};
}

StudyEnds AccuracyStudy::measure(int index) {
  const auto i = static_cast<std::size_t>(index);
  try {
    const auto truth = findTruth(cases_[i], inputs_[i].reference, folder_);
    if (!truth) return {true, ""};
    results_[i].reference = truth->report;
    const StudyEnds ends = measurePoints(i, truth->trace);
    if (ends.interrupted) return ends;
  } catch (const scenes::InputError& error) {
    return {false, error.what()};
  }
  return {};
}

void AccuracyStudy::finish() {
  progress_->finish();
  const auto isOurs = [&](const StudyPoint& point) {
    return std::any_of(cases_.begin(), cases_.end(),
                       [&](const StudyCase& study) { return study.name == point.key.study; });
  };
  std::vector<StudyPoint> points;
  for (const StudyPoint& point : store_.earlier()) {
    if (!isOurs(point)) points.push_back(point);
  }
  for (const StudyResults& results : results_) {
    points.insert(points.end(), results.points.begin(), results.points.end());
  }
  store_.rewrite(points);
}

}  // namespace app
