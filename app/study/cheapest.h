// The tables of a case: the cheapest way to an accuracy, and what each method did.
#pragma once

#include <string>
#include <vector>

#include "app/study/results.h"

namespace app {

constexpr double kTargets[] = {0.01, 0.001, 0.0001};  // of the case's scale

struct CheapestRow {
  double target = 0;
  const Trace* ours = nullptr;  // null: none of ours reaches it
  struct PeerPoint {
    int method = 0;
    const Trace* point = nullptr;  // null: it does not reach it
  };
  std::vector<PeerPoint> peers;  // those that ran at all
  // "ours takes 12 times less than Bullet", "only ours gets there"; where another engine is the
  // cheaper one, what of it is: "Bullet takes 1.4 times less: 100 steps per s at 2.1 µs, ours 400
  // at 0.7 µs".
  std::string verdict;
  bool oursWins = true;  // or nobody gets there
};
std::vector<CheapestRow> cheapestRows(const CaseResults& results);

struct MethodRow {
  int method = 0;
  const Trace* best = nullptr;  // null: nothing is ok
  std::optional<OrderFit> order;
  int measured = 0, failed = 0, skipped = 0;
  std::string refusal;  // why it cannot do the case
};
std::vector<MethodRow> methodRows(const CaseResults& results);

std::string percentText(double share);     // "0.1 %"
std::string secondsText(double seconds);   // "1.3 ms"
std::string numberText(double value);      // "3.1e-05"
std::string stepText(const Trace& point);  // "h = 0.01 s", "accuracy 1e-3"

// "ours is the cheapest, or alone, at 60 of 78 goals: 1 % and 0.1 % of 39 cases; at 48 by what is
// asked of it alone, without a choice of steps"
std::string goalsText(const std::vector<const CaseResults*>& cases);

// What `dbd study accuracy` says about a case.
std::string summaryText(const CaseResults& results);

}  // namespace app
