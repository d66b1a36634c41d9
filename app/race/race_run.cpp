// Steps a scene in several engines. One thread; the engines take turns at every frame, so that what
// slows the machine down slows all of them.
#include "app/race/race_run.h"

#include <fmt/format.h>

#include <stdexcept>

#include "app/base/interrupt.h"
#include "app/base/numbers.h"
#include "app/base/stopwatch.h"
#include "app/race/race_measure.h"
#include "physics/world/state.h"
#include "scenes/measure/series.h"

namespace app {

namespace {

using scenes::Simulation;

// One engine. `shown_` is where the states of all of them are measured: ours are put there too.
class Racer {
 public:
  Racer(const scenes::Scene& scene, const std::string& engine, double overlapShare)
      : shown_(scene), meter_(scene), checker_(withRoughExpectations(shown_, overlapShare)) {
    RaceStarter starter = startRacer(engine, shown_);
    track_.entry = starter.entry;
    peer_ = std::move(starter.peer);
    steps_ = starter.steps;
    poses_ = shown_.world().bodies().pose;
    velocities_ = shown_.world().bodies().velocity;
    if (!track_.ran()) return;
    if (!peer_) ours_.emplace(scene);
    keep(0);
  }

  const RaceEntry& entry() const { return track_.entry; }
  bool isRunning() const { return track_.ran() && !track_.gaveUp; }

  void advance() {
    const double before = processorSeconds();
    std::string problem = peer_ ? stepPeer() : stepOurs();
    const double seconds = processorSeconds() - before;
    if (problem.empty()) problem = show();
    if (problem.empty()) return keep(seconds);
    track_.gaveUp = {shown_.frame() + 1, problem};
  }

  RaceTrack finish() {
    for (const scenes::Checker::Verdict& verdict : checker_.verdicts()) note(verdict);
    return std::move(track_);
  }

 private:
  std::string stepPeer() {
    try {
      for (int k = 0; k < steps_; ++k) peer_->step(1.0 / (shown_.scene().fps * steps_));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    peer_->read(poses_, velocities_);
    return "";
  }

  std::string stepOurs() {
    if (ours_->advance().notFinite) return "not finite";
    poses_ = ours_->world().bodies().pose;
    velocities_ = ours_->world().bodies().velocity;
    return "";
  }

  std::string show() {
    if (shown_.place(poses_, velocities_)) return "";
    return fmt::format("not finite: {}",
                       shown_.bodyName(physics::firstNotFinite(poses_, velocities_)));
  }

  void keep(double seconds) {
    track_.samples.push_back(meter_.measure(shown_));
    track_.samples.back().milliseconds = 1e3 * seconds;
    track_.poses.push_back(shown_.world().bodies().pose);
    checker_.observe(shown_);
  }

  void note(const scenes::Checker::Verdict& verdict) {
    const scenes::Expectation& expectation = verdict.expectation;
    if (!verdict.failure) return;
    if (track_.missed && track_.missed->frame <= verdict.failure->frame) return;
    std::string unit = scenes::unitOf(expectation.metric);
    if (!unit.empty()) unit = " " + unit;
    track_.missed = {
        verdict.failure->frame,
        fmt::format("{} of {} {}{}, should be at {} {:.3g}{}", expectation.metric, expectation.body,
                    textBeyond(verdict.failure->value, verdict.bound), unit,
                    verdict.atMost ? "most" : "least", verdict.bound, unit)};
  }

  Simulation shown_;
  std::optional<Simulation> ours_;  // where the engine is ours
  std::unique_ptr<Peer> peer_;      // where it is another
  int steps_ = 1;                   // of it in a frame
  RaceMeter meter_;
  scenes::Checker checker_;
  std::vector<physics::Pose> poses_;
  std::vector<physics::Velocity> velocities_;
  RaceTrack track_;
};

void requireTwo(const std::vector<std::unique_ptr<Racer>>& racers, const scenes::Scene& scene) {
  int running = 0;
  std::string text = scene.name + ": fewer than two engines can run it";
  for (const auto& racer : racers) {
    running += racer->isRunning() ? 1 : 0;
    const RaceEntry& entry = racer->entry();
    if (!entry.refusal.empty()) text += fmt::format("\n  {}: {}", entry.title, entry.refusal);
  }
  if (running >= 2) return;
  throw scenes::InputError(text);
}

// True: all frames are there.
bool play(std::vector<std::unique_ptr<Racer>>& racers, const Race& race, ProgressMode mode) {
  Progress progress(mode, race.scene.name, "racing", race.frames);
  progress.advance();
  for (int frame = 1; frame < race.frames; ++frame) {
    for (std::size_t k = 0; k < racers.size(); ++k) {  // another one begins at every frame
      Racer& racer = *racers[(k + static_cast<std::size_t>(frame)) % racers.size()];
      if (interrupted()) return false;
      if (racer.isRunning()) racer.advance();
    }
    progress.advance();
  }
  progress.finish();
  return true;
}

}  // namespace

std::optional<Race> runRace(const scenes::Scene& scene, const std::vector<std::string>& engines,
                            const RaceLimits& limits, ProgressMode progress) {
  Race race{scene, scene.frameCount(), "", false, false, {}};
  std::vector<std::unique_ptr<Racer>> racers;
  for (const std::string& engine : engines) {
    racers.push_back(std::make_unique<Racer>(scene, engine, limits.overlap));
  }
  requireTwo(racers, scene);
  const Simulation start(scene);
  race.energyNote = energyNote(start);
  race.hasContacts = scene.settings.contact.has_value();
  race.hasJoints = !start.world().joints().empty();
  if (!play(racers, race, progress)) return std::nullopt;
  for (const auto& racer : racers) {
    race.tracks.push_back(racer->finish());
    RaceTrack& track = race.tracks.back();
    track.broke = findBreak(track, limits, race.energyNote.empty());
  }
  return race;
}

}  // namespace app
