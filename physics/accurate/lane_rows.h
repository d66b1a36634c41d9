// Motions of m, m + 1, ... m + k - 1 steps over the same time, side by side in lanes: which lane
// makes which of them, and which m costs least.
#pragma once

#include <array>

#include "physics/accurate/tableau.h"

namespace physics {

// Each lane makes one after the other.
struct LaneRows {
  struct Place {
    int lane, step;  // the step of the lane that a motion begins with
  };
  std::array<Place, Tableau::kMostRows> of;  // that of m + j steps
  int steps = 0;                             // of the lane that has most of them

  LaneRows(int first, int columns);
};

struct RowChoice {
  int first = 1;     // m
  double reach = 1;  // T_kk errs by as much as with 1, 2, ... k steps over a time 1/reach of it
  double step = 0;   // s
  double work = 0;   // lanes' steps by time
  double noise = 0;  // what rounding leaves of T_kk, of what rows are rounded to
};
// Of `left`, where rows of 1, 2, ... k steps may take `wanted`, and err by `allowed` by time.
RowChoice cheapestRows(int columns, double wanted, double left, double allowed = 1);

}  // namespace physics
