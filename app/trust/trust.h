// How long a simulation is true: the scene at its accuracy beside a tenth of it, and where the two
// part.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/base/progress.h"
#include "app/run/run_record.h"
#include "app/trust/event.h"

namespace app {

// What is compared.
struct TrustPlan {
  scenes::Scene scene, finer;
  double accuracy = 0;
  bool chosen = false;  // the accuracy: the scene states none
  int every = 1;        // frames of the finer run to one of the scene's
  std::string why;      // where it has more: what the accuracy does not step
};

struct Trust {
  TrustPlan plan;
  Track track, finer;
  std::vector<Allowed> allowed;              // by BodyId
  std::vector<FrameDifference> differences;  // by frame
  std::vector<int> apartAt;                  // by BodyId: the first frame beyond; -1: none
  int beyond = -1;                           // the first frame in which a body is; -1: none
  Growth growth;                             // of the body that is furthest beyond there
  std::optional<TrustEvent> event;
  ExitCode code = ExitCode::kDone;
  std::string problem;  // where numbers failed

  int frames() const { return static_cast<int>(differences.size()); }
  double until() const;  // s, of the last frame in which all bodies are within
  bool isWhole() const { return beyond < 0; }
};

// With an accuracy of its own, or 1e-2 where the scene and `overrides` state none. What it does not
// step all the time (ropes, cloth, soft bodies, other methods) gets a tenth of the step instead.
// `read`: the scene with these overrides. Throws InputError where a tenth of the accuracy is finer
// than scenes may ask for.
using SceneReader = std::function<scenes::Scene(const std::vector<std::string>& overrides)>;
TrustPlan planTrust(const SceneReader& read, std::vector<std::string> overrides);

// Runs both, side by side where there are two threads.
Trust measureTrust(const TrustPlan& plan, int threads, ProgressMode progress);

std::string trustText(const Trust& trust);    // some plain lines
std::string eventText(const Trust& trust);    // "impact of 'a' and 'b' at t = 1.2 s, in both runs"
std::string partingText(const Trust& trust);  // "t = 2.43 s: 'brick.12' is off by 3 mm"
std::string trustCsv(const Trust& trust);     // a row per frame
// version, scene, accuracy, accuracy_chosen, finer {accuracy, fps, why}, duration, trusted_until,
// whole, first_apart {frame, time, body, distance, allowed}, growth {from, to, rate},
// event {kind, frame, time, bodies, runs, text}, estimate, bodies [{name, size, allowed,
// apart_at}].
Json trustJson(const Trust& trust);

}  // namespace app
