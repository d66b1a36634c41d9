// What accuracy costs, all cases together: one diagram, and one sentence for each kind of scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/base/numbers.h"
#include "app/study/accuracy.h"
#include "app/study/asked.h"
#include "scenes/effects.h"

namespace app {

namespace {

struct SceneKind {
  const char* title;
  const char* color;
};
constexpr SceneKind kKinds[] = {{"free bodies and springs", "#009e73"},
                                {"joints", "#0072b2"},
                                {"contacts", "#d55e00"},
                                {"joints and contacts", "#882255"}};

// From what is on in the scene as it is simulated.
std::size_t kindOf(const CaseResults& results) {
  bool joints = false, contacts = false;
  for (const scenes::Effect& effect : scenes::effectsOf(scenes::studyScene(results.study, {}))) {
    joints = joints || (effect.on && effect.part == scenes::EffectPart::kConstraints);
    contacts = contacts || (effect.on && effect.name == "contact");
  }
  return (joints ? 1u : 0u) + (contacts ? 2u : 0u);
}

// A case that ran at every accuracy that all were asked for.
struct Asked {
  std::map<double, double> costs;  // by what was asked, the finest first
  std::map<double, double> peers;  // the least cost of another engine that is as good
  int delivered = 0;               // of `costs`: with an error of at most kDelivered times that
};

Asked askedOf(const CaseResults& results) {
  Asked asked;
  for (const Trace& point : results.points) {
    if (point.key.accuracy <= 0 || !point.isOk()) continue;
    asked.costs[point.key.accuracy] = point.cost();
    const double error = kDelivered * point.key.accuracy;
    asked.delivered += results.relative(point.errors.error) <= error ? 1 : 0;
    for (const Trace* peer : results.peers()) {
      if (!peer->isOk() || results.relative(peer->errors.error) > error) continue;
      auto [found, isNew] = asked.peers.try_emplace(point.key.accuracy, peer->cost());
      found->second = std::min(found->second, peer->cost());
    }
  }
  return asked;
}

// All cases of a kind: geometric means.
struct KindCosts {
  int cases = 0, asked = 0, delivered = 0;
  std::vector<ChartPoint> ours, peers;
};

KindCosts meansOf(const std::vector<Asked>& all) {
  std::size_t most = 0;
  for (const Asked& asked : all) most = std::max(most, asked.costs.size());
  std::map<double, std::pair<double, int>> ours, ratios;  // sums of logarithms, and counts
  KindCosts result;
  for (const Asked& asked : all) {
    if (asked.costs.size() < most) continue;  // else the mean would change its members
    ++result.cases;
    result.asked += static_cast<int>(asked.costs.size());
    result.delivered += asked.delivered;
    for (const auto& [accuracy, cost] : asked.costs) {
      ours[accuracy].first += std::log(cost);
      ++ours[accuracy].second;
      const auto peer = asked.peers.find(accuracy);
      if (peer == asked.peers.end()) continue;
      ratios[accuracy].first += std::log(peer->second / cost);
      ++ratios[accuracy].second;
    }
  }
  for (const auto& [accuracy, sum] : ours) {
    const double mean = std::exp(sum.first / sum.second);
    result.ours.push_back({accuracy, mean});
    if (const auto found = ratios.find(accuracy); found != ratios.end()) {
      result.peers.push_back(
          {accuracy, mean * std::exp(found->second.first / found->second.second)});
    }
  }
  return result;
}

// How much more ten times the accuracy costs: the slope of a line through the logarithms.
double timesPerDecade(const std::vector<ChartPoint>& points) {
  const auto n = static_cast<double>(points.size());
  double meanX = 0, meanY = 0, xx = 0, xy = 0;
  for (const ChartPoint& p : points) {
    meanX += std::log10(p.x) / n;
    meanY += std::log10(p.y) / n;
  }
  for (const ChartPoint& p : points) {
    xx += std::pow(std::log10(p.x) - meanX, 2);
    xy += (std::log10(p.x) - meanX) * (std::log10(p.y) - meanY);
  }
  return std::pow(10, -xy / xx);
}

std::string sentence(const SceneKind& kind, const KindCosts& costs) {
  const ChartPoint &fine = costs.ours.front(), &coarse = costs.ours.back();
  std::string text = fmt::format(
      "{} ({} case{}): ten times more accurate costs {:.2g} times more; {} for a "
      "simulated second at {}, {} at {}; {} of {} were delivered",
      kind.title, costs.cases, costs.cases == 1 ? "" : "s", timesPerDecade(costs.ours),
      secondsText(coarse.y), accuracyText(coarse.x), secondsText(fine.y), accuracyText(fine.x),
      costs.delivered, costs.asked);
  if (costs.peers.empty()) return text + "; no other engine is as good.";
  return text +
         fmt::format("; the finest that another engine delivers, within 3 times as well, is {}.",
                     accuracyText(costs.peers.front().x));
}

void addKind(const SceneKind& kind, int marker, const KindCosts& costs, Chart& chart) {
  chart.series.push_back(
      {fmt::format("{}, {} case{}", kind.title, costs.cases, costs.cases == 1 ? "" : "s"),
       costs.ours, kind.color, marker, 1.0, true, 2.5});
  if (costs.peers.empty()) return;
  chart.series.push_back({"   the best other engine", costs.peers, kind.color, marker + 6, 1.3});
}

}  // namespace

Glance glanceAt(const std::vector<const CaseResults*>& cases) {
  std::vector<std::vector<Asked>> byKind(std::size(kKinds));
  for (const CaseResults* results : cases) {
    Asked asked = askedOf(*results);
    if (!asked.costs.empty()) byKind[kindOf(*results)].push_back(std::move(asked));
  }
  Glance glance;
  Chart chart{.name = "glance", .title = "What accuracy costs"};
  chart.alt = "time for a simulated second over the accuracy asked for";
  chart.caption =
      "Lines: ours, asked for an accuracy; geometric means over the cases of a kind. Open marks: "
      "as far above or below the line as the cheapest other engine with an error of at most three "
      "times that accuracy is dearer or cheaper, over those cases where one is as good.";
  std::vector<double> xs, ys;
  for (std::size_t k = 0; k < byKind.size(); ++k) {
    const KindCosts costs = meansOf(byKind[k]);
    if (costs.ours.size() < 2) continue;
    glance.sentences.push_back(sentence(kKinds[k], costs));
    addKind(kKinds[k], static_cast<int>(k), costs, chart);
    for (const auto* points : {&costs.ours, &costs.peers}) {
      for (const ChartPoint& p : *points) {
        xs.push_back(p.x);
        ys.push_back(p.y);
      }
    }
  }
  if (xs.empty()) return glance;
  chart.x = logAxis("accuracy asked for: finer to the right", xs);
  chart.x.low /= 2;
  chart.x.high *= 2;
  chart.x.reversed = true;
  chart.y = logAxis("time for a simulated second [s]", ys);
  chart.right = 0.66;
  glance.chart = std::move(chart);
  return glance;
}

}  // namespace app
