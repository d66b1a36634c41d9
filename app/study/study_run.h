// Runs a point of a study in our engine or in another, sample by sample, and times the steps.
#pragma once

#include <memory>
#include <optional>

#include "app/peers/peer.h"
#include "app/study/study_effort.h"
#include "app/study/study_point.h"

namespace app {

// The overrides that make the case's scene that of a point.
std::vector<std::string> overridesOf(const scenes::StudyGrid& grid,
                                     const scenes::StudyMethod& method,
                                     const scenes::StudyCase& study, const StudyKey& key);

struct StudyCounts {  // over a run
  double evaluations = 0, sweeps = 0, restarts = 0, fallbacks = 0;
  double estimate = 0;  // of the error of a step, relative; the largest
};

// One simulation of a point.
class StudyRun {
 public:
  // Throws InputError where the method cannot do the scene. `scene` was made with overridesOf.
  StudyRun(const scenes::Scene& scene, const scenes::StudyCase& study,
           const scenes::StudyMethod& method, const StudyKey& key);

  bool advance();  // to the next sample; false: a number was not finite, or the engine gave up

  const scenes::Simulation& simulation() const { return simulation_; }
  const StudyCounts& counts() const { return counts_; }
  const std::string& problem() const { return problem_; }
  double wall() const { return wall_; }            // s, spent in steps so far
  double processor() const { return processor_; }  // s

 private:
  bool advanceOurs();
  bool advancePeer();

  scenes::Simulation simulation_;
  std::unique_ptr<Peer> peer_;
  std::vector<physics::Pose> poses_;
  std::vector<physics::Velocity> velocities_;
  int steps_ = 1;  // of the simulation or the peer per sample
  double h_ = 0;   // of the peer
  StudyCounts counts_;
  std::string problem_;
  double wall_ = 0, processor_ = 0;
};

// Measures a point against the truth. None: interrupted. Never throws for what the point does.
std::optional<StudyPoint> measurePoint(const scenes::StudyCase& study,
                                       const scenes::StudyMethod& method,
                                       const scenes::StudyGrid& grid, const StudyKey& key,
                                       const scenes::StudyTrace& truth, const StudyEffort& effort);

// h of a key [s]; 0: it asks for an accuracy instead.
double stepOf(const scenes::StudyCase& study, const StudyKey& key);

}  // namespace app
