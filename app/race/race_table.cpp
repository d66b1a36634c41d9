// A race in numbers.
#include "app/race/race_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/build_info.h"
#include "app/base/json.h"
#include "app/base/machine.h"
#include "app/base/numbers.h"
#include "app/run/run_record.h"
#include "app/run/step_clock.h"

namespace app {

namespace {

std::string row(const RaceTrack& track, const Race& race) {
  if (!track.ran()) {
    return fmt::format("{:<14} does not run: {}\n", track.entry.title, track.entry.refusal);
  }
  const RaceWorst worst = worstOf(track);
  const auto measure = [](bool there, double length, double share) {
    return there ? lengthText(length) + ", " + shareText(share) : std::string("none");
  };
  std::string text = fmt::format(
      "{:<14} {:>8.3g} {:>8.3g} {:>8.3g}  {:<18} {:<18} {:<16} {}\n", track.entry.title,
      worst.median, worst.mean, worst.slowest,
      measure(race.hasContacts, worst.overlap, worst.overlapShare),
      measure(race.hasJoints, worst.gap, worst.gapShare),
      shareText(worst.energyMost) + ", " + shareText(worst.energyEnd),
      track.broke
          ? fmt::format("{:.2f} s: {}", static_cast<double>(track.broke->frame) / race.scene.fps,
                        track.broke->what)
          : "never");
  return text;
}

Json describe(const std::optional<RaceBreak>& what, int fps) {
  if (!what) return {};
  return {{"frame", what->frame},
          {"time", static_cast<double>(what->frame) / fps},
          {"what", what->what}};
}

Json describe(const RaceTrack& track, int fps) {
  Json json = {
      {"engine", track.entry.engine}, {"title", track.entry.title}, {"setup", track.entry.setup}};
  json["refusal"] = track.ran() ? Json() : Json(track.entry.refusal);
  if (!track.ran()) return json;
  const RaceWorst worst = worstOf(track);
  json["frames"] = track.samples.size();
  json["milliseconds"] = {
      {"median", worst.median}, {"mean", worst.mean}, {"slowest", worst.slowest}};
  json["overlap"] = {{"metres", worst.overlap}, {"share", worst.overlapShare}};
  json["gap"] = {{"metres", worst.gap}, {"share", worst.gapShare}};
  json["energy_change"] = {{"most", worst.energyMost}, {"end", worst.energyEnd}};
  json["missed"] = describe(track.missed, fps);
  json["gave_up"] = describe(track.gaveUp, fps);
  json["broke"] = describe(track.broke, fps);
  return json;
}

}  // namespace

RaceWorst worstOf(const RaceTrack& track) {
  RaceWorst worst;
  std::vector<double> milliseconds;
  for (const RaceSample& sample : track.samples) {
    if (&sample != &track.samples.front()) milliseconds.push_back(sample.milliseconds);
    worst.overlap = std::max(worst.overlap, sample.overlap);
    worst.overlapShare = std::max(worst.overlapShare, sample.overlapShare);
    worst.gap = std::max(worst.gap, sample.gap);
    worst.gapShare = std::max(worst.gapShare, sample.gapShare);
    worst.energyMost = std::max(worst.energyMost, sample.energyChange);
  }
  worst.energyEnd = track.samples.back().energyChange;
  for (const double ms : milliseconds) {
    worst.mean += ms / static_cast<double>(milliseconds.size());
    worst.slowest = std::max(worst.slowest, ms);
  }
  worst.median = medianOf(std::move(milliseconds));
  return worst;
}

std::string shareText(double share) {
  constexpr double kNothing = 5e-6;
  if (std::abs(share) < kNothing) return "0 %";
  if (std::abs(share) < 1) return fmt::format("{:.2g} %", 100 * share);
  if (std::abs(share) < 10) return fmt::format("{:.0f} %", 100 * share);
  return std::abs(share) < 1e4 ? fmt::format("{:.0f} times", share)
                               : fmt::format("{:.0e} times", share);
}

double recentMilliseconds(const RaceTrack& track, int frame, int fps) {
  const int last = std::min(frame, static_cast<int>(track.samples.size()) - 1);
  const int first = std::max(1, last - fps / 2 + 1);
  double sum = 0;
  for (int k = first; k <= last; ++k)
    sum += track.samples[static_cast<std::size_t>(k)].milliseconds;
  return last >= first ? sum / (last - first + 1) : 0;
}

std::string raceTable(const Race& race, const RaceLimits& limits) {
  std::string text =
      fmt::format("{}, {:.3g} s, one thread each, nothing sleeps\n", race.scene.title,
                  static_cast<double>(race.frames - 1) / race.scene.fps);
  for (const RaceTrack& track : race.tracks) {
    text += fmt::format("{:<14} {}\n", track.entry.title,
                        track.ran() ? track.entry.setup : "does not run");
  }
  text +=
      fmt::format("\n{:<14} {:>8} {:>8} {:>8}  {:<18} {:<18} {:<16} {}\n", "ms/frame:", "median",
                  "mean", "worst", "overlap", "joint gap", "energy most, end", "broke");
  for (const RaceTrack& track : race.tracks) text += row(track, race);
  text += "\nBroken is who has\n";
  for (const std::string& line : criteriaOf(race, limits)) text += "  " + line + "\n";
  return text + "\n" + raceVerdict(race);
}

std::string raceCsv(const Race& race) {
  std::string text =
      "frame,time,engine,milliseconds,overlap,overlap_share,gap,gap_share,energy,energy_change,"
      "broken\n";
  for (int frame = 0; frame < race.frames; ++frame) {
    for (const RaceTrack& track : race.tracks) {
      if (frame >= static_cast<int>(track.samples.size())) continue;
      const RaceSample& s = track.samples[static_cast<std::size_t>(frame)];
      text += fmt::format("{},{:.9g},{},{:.4g},{:.9g},{:.9g},{:.9g},{:.9g},{:.17g},{:.9g},{}\n",
                          frame, static_cast<double>(frame) / race.scene.fps, track.entry.engine,
                          s.milliseconds, s.overlap, s.overlapShare, s.gap, s.gapShare, s.energy,
                          s.energyChange, track.broke && track.broke->frame <= frame ? 1 : 0);
    }
  }
  return text;
}

std::string raceJson(const Race& race, const RaceLimits& limits, const std::string& film) {
  Json json = {{"program", {{"version", version()}, {"hash", programHash()}}},
               {"machine", {{"processor", processorName()}, {"load", loadAverage()}}},
               {"scene",
                {{"name", race.scene.name},
                 {"title", race.scene.title},
                 {"text_hash", sceneHash(race.scene)},
                 {"overrides", race.scene.overrides},
                 {"fps", race.scene.fps},
                 {"frames", race.frames}}},
               {"criteria", criteriaOf(race, limits)},
               {"limits",
                {{"gap_share", limits.gap},
                 {"overlap_share", limits.overlap},
                 {"energy_change", limits.energy}}},
               {"missing", missingRaceEngines()},
               {"engines", Json::array()}};
  for (const RaceTrack& track : race.tracks) {
    json["engines"].push_back(describe(track, race.scene.fps));
  }
  json["verdict"] = raceVerdict(race);
  json["film"] = film.empty() ? Json() : Json(film);
  return jsonText(json, 2) + "\n";
}

}  // namespace app
