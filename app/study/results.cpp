// Plans of points, and questions to their results.
#include "app/study/results.h"

#include <algorithm>
#include <cmath>

#include "app/base/machine.h"

namespace app {

namespace {

// At most `most` of the values, the ends among them.
template <class T>
std::vector<T> thinned(std::vector<T> values, std::size_t most) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() <= most) return values;
  std::vector<T> result;
  for (std::size_t i = 0; i < most; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(most - 1);
    const double at = share * static_cast<double>(values.size() - 1);
    result.push_back(values[static_cast<std::size_t>(std::lround(at))]);
  }
  return result;
}

// The points of a method that is asked for accuracies, the coarsest first.
void planAsked(const std::vector<double>& accuracies, const PlannedPoint& first,
               std::vector<PlannedPoint>& plan) {
  for (std::size_t i = accuracies.size(); i-- > 0;) {
    plan.push_back(first);
    plan.back().key.accuracy = accuracies[i];
  }
}

template <class Better>
const Trace* choose(const std::vector<Trace>& points, Better better) {
  const Trace* best = nullptr;
  for (const Trace& point : points) {
    if (point.isOk() && (best == nullptr || better(point, *best))) best = &point;
  }
  return best;
}

std::vector<const Trace*> pointsOf(const CaseResults& results, bool ofPeers) {
  std::vector<const Trace*> chosen;
  for (const Trace& point : results.points) {
    const auto m = static_cast<std::size_t>(results.methodOf(point));
    if (results.study.methods[m].peer.empty() != ofPeers) chosen.push_back(&point);
  }
  return chosen;
}

}  // namespace

std::vector<PlannedPoint> planPoints(const scenes::StudyCase& study, bool quick) {
  constexpr std::size_t kAll = 1'000'000;
  std::vector<PlannedPoint> plan;
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    const scenes::StudyGrid& grid = study.grids[m];
    if (study.methods[m].asks) {
      planAsked(thinned(grid.accuracies, quick ? 3 : kAll),
                {static_cast<int>(m), {study.name, study.methods[m].name}}, plan);
      continue;
    }
    const auto begin = plan.size();
    for (const int iterations : thinned(grid.iterations, quick ? 2 : kAll)) {
      for (const int steps : thinned(grid.steps, quick ? 2 : kAll)) {
        for (const int substeps : thinned(grid.substeps, quick ? 4 : kAll)) {
          plan.push_back({static_cast<int>(m),
                          {study.name, study.methods[m].name, steps, substeps, iterations}});
        }
      }
    }
    std::stable_sort(plan.begin() + static_cast<std::ptrdiff_t>(begin), plan.end(),
                     [](const PlannedPoint& a, const PlannedPoint& b) {
                       return a.key.iterations != b.key.iterations
                                  ? a.key.iterations < b.key.iterations
                                  : a.key.work() < b.key.work();
                     });
  }
  return plan;
}

std::vector<const Trace*> CaseResults::of(int method) const {
  std::vector<const Trace*> result;
  for (const Trace& point : points) {
    if (methodOf(point) == method) result.push_back(&point);
  }
  return result;
}

std::vector<const Trace*> CaseResults::ours() const { return pointsOf(*this, false); }
std::vector<const Trace*> CaseResults::peers() const { return pointsOf(*this, true); }

double CaseResults::relative(double error) const {
  const bool isSquare = study.error == scenes::StudyCase::Error::kMeanSquare;
  return isSquare ? std::sqrt(error / study.scale) : error / study.scale;
}

bool CaseResults::hasSteps() const {
  return std::any_of(points.begin(), points.end(),
                     [](const Trace& point) { return point.isOk() && point.h > 0; });
}

const Trace* CaseResults::best() const {
  return choose(points,
                [](const Trace& a, const Trace& b) { return a.errors.error < b.errors.error; });
}

const Trace* CaseResults::worst() const {
  return choose(points,
                [](const Trace& a, const Trace& b) { return a.errors.error > b.errors.error; });
}

int CaseResults::methodOf(const Trace& point) const {
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    if (study.methods[m].name == point.key.method) return static_cast<int>(m);
  }
  return 0;
}

std::string CaseResults::methodTitle(const Trace& point) const { return titleOf(methodOf(point)); }

std::string CaseResults::titleOf(int method) const {
  return study.methods[static_cast<std::size_t>(method)].title;
}

std::optional<OrderFit> CaseResults::order(int method) const {
  constexpr double kFloor = 5, kCeiling = 0.3;  // times the reference's error, times the scale
  const Trace* best = nullptr;
  const std::vector<const Trace*> own = of(method);
  for (const Trace* point : own) {
    const bool better = best == nullptr || point->errors.error < best->errors.error;
    if (point->isOk() && better) best = point;
  }
  if (best == nullptr) return std::nullopt;
  const bool isSquare = study.error == scenes::StudyCase::Error::kMeanSquare;
  const auto root = [&](double error) { return isSquare ? std::sqrt(error) : error; };
  std::vector<StepError> pairs;
  for (const Trace* point : own) {
    const bool same = point->key.iterations == best->key.iterations;
    if (point->isOk() && same && point->h > 0)
      pairs.push_back({point->h, root(point->errors.error)});
  }
  return fitOrder(pairs, kFloor * root(reference.accuracy.value_or(0)),
                  kCeiling * root(study.scale));
}

bool CaseResults::wasBusy() const {
  constexpr double kWaiting = 1.1, kOwnLoad = 1.5;
  int measured = 0, waited = 0, loaded = 0;
  for (const Trace& point : points) {
    if (!point.isOk() || point.wall <= 0) continue;
    ++measured;
    waited += point.wall > kWaiting * point.processor ? 1 : 0;
    loaded += point.load > kOwnLoad ? 1 : 0;
  }
  return 10 * waited > measured || 2 * loaded > measured;
}

}  // namespace app
