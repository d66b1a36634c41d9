// Where two runs part, of any programs, machines or settings: the first frame, body and quantity.
#pragma once

#include <string>
#include <vector>

#include "app/trust/difference.h"
#include "app/trust/run_source.h"

namespace app {

struct Divergence {
  int frames = 0;  // that both have
  int first = -1;  // the first frame that differs; -1: none of these
  bool sameLength = true;
  Parting parting;  // of that frame, where the states of both are known; frame -1: they are not
  std::vector<FrameDifference> differences;  // of centres [m], of the frames known of both
  std::vector<std::string> inputs;           // what the two were run with, where that differs

  bool isSame() const { return first < 0 && sameLength; }
};

// Throws InputError where they are not of the same bodies, or not at the same times.
Divergence compareRuns(const RunSource& a, const RunSource& b);

std::string divergeText(const RunSource& a, const RunSource& b, const Divergence& divergence);
std::string divergeCsv(const RunSource& a, const Divergence& divergence);  // a row per frame
// version, a, b {path, program, frames}, same, frames, first {frame, time, body, quantity, a, b,
// distance, bodies}, most {frame, time, body, distance}, inputs.
Json divergeJson(const RunSource& a, const RunSource& b, const Divergence& divergence);

}  // namespace app
