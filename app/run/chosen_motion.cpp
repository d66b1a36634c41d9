// Which motion a run draws: one that is there, or a new one.
#include "app/run/chosen_motion.h"

#include <fmt/format.h>

#include "app/base/console.h"

namespace app {

namespace {

constexpr const char* kMotionFile = "motion.npz";

bool showsContacts(const scenes::Overlays& overlays) {
  return overlays.contacts || overlays.impulses || overlays.vectors;
}

bool wantsContacts(const RenderJob& job) {
  return job.keepsMotion || showsContacts(job.view.overlays);
}

Motion openGiven(const scenes::Simulation& start, const RenderJob& job) {
  Motion motion = Motion::open(job.from);
  motion.fitTo(start);
  if (job.frames.back() >= motion.frames()) {
    throw scenes::InputError(fmt::format("{}: frame {} is wanted, and it holds {} frames",
                                         job.from.string(), job.frames.back(), motion.frames()));
  }
  if (showsContacts(job.view.overlays) && !motion.hasContacts()) {
    throw scenes::InputError(
        job.from.string() +
        ": contacts are to be drawn, and it holds none; `dbd simulate --motion` keeps them");
  }
  return motion;
}

// What an earlier run of the same inputs left behind, if it is enough.
std::optional<Motion> openEarlier(const scenes::Simulation& start, const RenderJob& job,
                                  const RunRecord& record) {
  const std::filesystem::path file = job.folder / kMotionFile;
  if (job.fresh || !std::filesystem::is_regular_file(file)) return std::nullopt;
  try {
    Motion motion = Motion::open(file);
    const Json& about = motion.about();
    const bool same = about.value("program", Json()) == record.program &&
                      about.value("scene", Json()) == record.scene &&
                      about.value("settings", Json()) == record.settings;
    if (!same) return std::nullopt;
    motion.fitTo(start);
    const bool enough = motion.frames() >= framesNeeded(start.scene(), job) &&
                        (motion.hasContacts() || !wantsContacts(job));
    if (!enough) return std::nullopt;
    return motion;
  } catch (const scenes::InputError&) {
    return std::nullopt;  // it is made again
  }
}

}  // namespace

ChosenMotion beginMotion(const std::filesystem::path& path, const scenes::Simulation& start,
                         int frames, Motion::Keep keep, const RunRecord& record, bool fresh) {
  Checkpoint checkpoint(path, Checkpoint::runOf(record, frames, static_cast<int>(keep)));
  if (std::optional<physics::Archive> state = fresh ? std::nullopt : checkpoint.open()) {
    try {
      Motion motion = Motion::goOn(path, start, frames, keep);
      (*state)(motion);
      return {std::move(motion), false, std::move(checkpoint), state};
    } catch (const std::invalid_argument& error) {
      note(fmt::format("dbd: warning: {}; it is simulated from the beginning\n", error.what()));
    }
  }
  checkpoint.remove();
  return {Motion::begin(path, start, frames, keep), false, std::move(checkpoint), std::nullopt};
}

ChosenMotion chooseMotion(const scenes::Simulation& start, const RenderJob& job,
                          const RunRecord& record) {
  if (!job.from.empty()) return {openGiven(start, job), true, {}, {}};
  const std::filesystem::path file = job.folder / kMotionFile;
  if (std::optional<Motion> earlier = openEarlier(start, job, record)) {
    Checkpoint(file, {}).remove();  // of a run that was killed after its motion was whole
    return {std::move(*earlier), true, {}, {}};
  }
  const auto keep = wantsContacts(job) ? Motion::Keep::kContacts : Motion::Keep::kPoses;
  return beginMotion(file, start, framesNeeded(start.scene(), job), keep, record, job.fresh);
}

void commit(ChosenMotion& motion, const Json& about) {
  motion.motion.commit(about);
  if (motion.checkpoint) motion.checkpoint->remove();
}

void noteGoesOn(const scenes::Simulation& simulation, ProgressMode progress) {
  if (progress == ProgressMode::kNone || progress == ProgressMode::kJson) return;
  note(fmt::format("{}: goes on from frame {}\n", simulation.scene().name, simulation.frame()));
}

Motion drawnMotion(const scenes::Simulation& start, const RenderJob& job) {
  Motion motion = Motion::open(job.from.empty() ? job.folder / kMotionFile : job.from);
  motion.fitTo(start);
  return motion;
}

int framesNeeded(const scenes::Scene& scene, const RenderJob& job) {
  return scenes::needsMotionBounds(scene) ? scene.frameCount() : job.frames.back() + 1;
}

Json describeMotion(const scenes::Scene& scene, const RunRecord& record) {
  return {{"path", scene.path},
          {"program", record.program},
          {"scene", record.scene},
          {"settings", record.settings},
          {"expectations", record.expectations}};
}

}  // namespace app
