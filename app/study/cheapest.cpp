// Rows of tables, and the summary on standard output.
#include "app/study/cheapest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/numbers.h"

namespace app {

namespace {

// Steps per simulated second and what one of them costs, where the steps are known.
std::string stepsOf(const Trace& point) {
  const double steps = point.h > 0 ? 1 / point.h : point.pieces;
  if (!(steps > 0)) return fmt::format("{} per s", secondsText(point.cost()));
  return fmt::format("{:.3g} steps per s at {}", steps, secondsText(point.cost() / steps));
}

std::string reason(const CaseResults& results, const Trace* ours, const Trace& other) {
  if (ours == nullptr) {
    const std::vector<const Trace*> own = results.ours();
    const Trace* best = nullptr;
    for (const Trace* point : own) {
      if (point->isOk() && (best == nullptr || point->errors.error < best->errors.error))
        best = point;
    }
    if (best == nullptr) return ": nothing of ours is ok";
    return fmt::format(": {}; the least error of ours is {} {}", stepsOf(other),
                       numberText(best->errors.error), results.study.unit);
  }
  return fmt::format(": {}, ours {}", stepsOf(other), stepsOf(*ours));
}

bool ran(const std::vector<const Trace*>& points) {
  return std::any_of(points.begin(), points.end(),
                     [](const Trace* point) { return point->isOk() || point->isFailure(); });
}

// Who of ours and the best peer is faster, in words.
void judge(const CaseResults& results, CheapestRow& row) {
  const CheapestRow::PeerPoint* best = nullptr;
  for (const CheapestRow::PeerPoint& peer : row.peers) {
    const bool better =
        peer.point != nullptr && (best == nullptr || peer.point->cost() < best->point->cost());
    if (better) best = &peer;
  }
  if (row.ours == nullptr && best == nullptr) {
    row.verdict = "nobody gets there";
    return;
  }
  row.oursWins =
      row.ours != nullptr && (best == nullptr || row.ours->cost() <= best->point->cost());
  if (best == nullptr) {
    row.verdict = row.peers.empty() ? "" : "only ours gets there";
  } else if (row.ours == nullptr) {
    row.verdict = fmt::format("only {} gets there{}", results.titleOf(best->method),
                              reason(results, nullptr, *best->point));
  } else {
    const double ratio = row.oursWins ? best->point->cost() / row.ours->cost()
                                      : row.ours->cost() / best->point->cost();
    row.verdict = row.oursWins
                      ? fmt::format("ours takes {:.3g} times less than {}", ratio,
                                    results.titleOf(best->method))
                      : fmt::format("{} takes {:.3g} times less{}", results.titleOf(best->method),
                                    ratio, reason(results, row.ours, *best->point));
  }
}

std::string pointText(const CaseResults& results, const Trace* point) {
  if (point == nullptr) return "not reached";
  return fmt::format("{} per s ({}, {})", secondsText(point->cost()), results.methodTitle(*point),
                     stepText(*point));
}

}  // namespace

std::vector<CheapestRow> cheapestRows(const CaseResults& results) {
  std::vector<CheapestRow> rows;
  const std::vector<const Trace*> ours = results.ours();
  for (const double target : kTargets) {
    CheapestRow row;
    row.target = target;
    row.ours = cheapest(ours, target * results.study.scale);
    for (std::size_t m = 0; m < results.study.methods.size(); ++m) {
      const std::vector<const Trace*> own = results.of(static_cast<int>(m));
      if (results.study.methods[m].peer.empty() || !ran(own)) continue;
      row.peers.push_back({static_cast<int>(m), cheapest(own, target * results.study.scale)});
    }
    judge(results, row);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<MethodRow> methodRows(const CaseResults& results) {
  std::vector<MethodRow> rows;
  for (std::size_t m = 0; m < results.study.methods.size(); ++m) {
    MethodRow row;
    row.method = static_cast<int>(m);
    row.order = results.order(row.method);
    for (const Trace* point : results.of(row.method)) {
      row.measured += point->isOk() ? 1 : 0;
      row.failed += point->isFailure() ? 1 : 0;
      row.skipped += point->status == Trace::Status::kSkipped ? 1 : 0;
      if (point->status == Trace::Status::kRefused) row.refusal = point->message;
      const bool better = row.best == nullptr || point->errors.error < row.best->errors.error;
      if (point->isOk() && better) row.best = point;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

namespace {

// True: what steps by an accuracy is the cheapest, or alone.
bool winsByAccuracy(const CaseResults& results, const CheapestRow& row) {
  std::vector<const Trace*> asked = results.ours();
  std::erase_if(asked, [](const Trace* point) { return !(point->key.accuracy > 0); });
  const Trace* ours = cheapest(asked, row.target * results.study.scale);
  return ours != nullptr &&
         std::all_of(row.peers.begin(), row.peers.end(), [&](const CheapestRow::PeerPoint& peer) {
           return peer.point == nullptr || ours->cost() <= peer.point->cost();
         });
}

}  // namespace

std::string goalsText(const std::vector<const CaseResults*>& cases) {
  constexpr std::size_t kGoals = 2;  // the first of kTargets
  int won = 0, asked = 0;
  for (const CaseResults* results : cases) {
    const std::vector<CheapestRow> rows = cheapestRows(*results);
    for (std::size_t i = 0; i < kGoals; ++i) {
      won += rows[i].ours != nullptr && rows[i].oursWins ? 1 : 0;
      asked += winsByAccuracy(*results, rows[i]) ? 1 : 0;
    }
  }
  return fmt::format(
      "ours is the cheapest, or alone, at {} of {} goals: {} and {} of {} cases; at {} by what is "
      "asked of it alone, without a choice of steps",
      won, kGoals * cases.size(), percentText(kTargets[0]), percentText(kTargets[1]), cases.size(),
      asked);
}

std::string stepText(const Trace& point) {
  if (point.key.accuracy > 0) return point.key.text();
  return fmt::format("h = {} s", numberText(point.h));
}

std::string summaryText(const CaseResults& results) {
  const scenes::StudyCase& study = results.study;
  std::string text =
      fmt::format("{}: {}\n  reference: {}", study.name, study.title, results.reference.what);
  if (results.reference.accuracy) {
    text += fmt::format(", its own error about {} {}", numberText(*results.reference.accuracy),
                        study.unit);
  }
  text += "\n";
  for (const MethodRow& row : methodRows(results)) {
    const std::string order = row.order ? fmt::format(", order {:.2f} over {} points",
                                                      row.order->order, row.order->points)
                                        : "";
    text += fmt::format("  {:<28} ", results.titleOf(row.method));
    if (row.best != nullptr) {
      text += fmt::format("least error {} {} for {} per s{}", numberText(row.best->errors.error),
                          study.unit, secondsText(row.best->cost()), order);
    } else {
      text += row.refusal.empty() ? "nothing that is ok" : "refused: " + row.refusal;
    }
    if (row.failed > 0) text += fmt::format(", {} failed", row.failed);
    if (row.skipped > 0) text += fmt::format(", {} not measured: too long", row.skipped);
    text += "\n";
  }
  for (const CheapestRow& row : cheapestRows(results)) {
    text += fmt::format("  to {:<6} {}{}\n", percentText(row.target), pointText(results, row.ours),
                        row.verdict.empty() ? "" : "; " + row.verdict);
  }
  return text;
}

}  // namespace app
