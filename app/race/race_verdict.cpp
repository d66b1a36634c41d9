// Who broke first, and what counts as broken.
#include "app/race/race_verdict.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/numbers.h"
#include "app/race/race_table.h"

namespace app {

namespace {

bool isEarlier(const std::optional<RaceBreak>& a, const std::optional<RaceBreak>& b) {
  return a && (!b || a->frame < b->frame);
}

std::string shareBeyond(double share, double limit) {
  const std::string text = shareText(share);
  return text != shareText(limit) ? text : textBeyond(100 * share, 100 * limit) + " %";
}

}  // namespace

std::string beyondLimits(const RaceSample& sample, const RaceLimits& limits, bool energyCounts) {
  if (sample.gapShare > limits.gap) {
    return "joint gap " + shareBeyond(sample.gapShare, limits.gap) + " of the smaller body";
  }
  if (sample.overlapShare > limits.overlap) {
    return "overlap " + shareBeyond(sample.overlapShare, limits.overlap) + " of the thinner body";
  }
  if (energyCounts && sample.energyChange > limits.energy) {
    return "energy " + shareBeyond(sample.energyChange, limits.energy) + " from nowhere";
  }
  return "";
}

std::optional<RaceBreak> findBreak(const RaceTrack& track, const RaceLimits& limits,
                                   bool energyCounts) {
  std::optional<RaceBreak> first;
  for (std::size_t frame = 0; frame < track.samples.size() && !first; ++frame) {
    const std::string what = beyondLimits(track.samples[frame], limits, energyCounts);
    if (!what.empty()) first = {static_cast<int>(frame), what};
  }
  if (isEarlier(track.missed, first)) first = track.missed;
  if (isEarlier(track.gaveUp, first)) first = track.gaveUp;
  return first;
}

std::string raceVerdict(const Race& race) {
  std::vector<const RaceTrack*> broken;
  std::string text, whole;
  for (const RaceTrack& track : race.tracks) {
    if (!track.ran()) continue;
    if (track.broke) {
      broken.push_back(&track);
    } else {
      whole += (whole.empty() ? "" : ", ") + track.entry.title;
    }
  }
  std::stable_sort(broken.begin(), broken.end(), [](const RaceTrack* a, const RaceTrack* b) {
    return a->broke->frame < b->broke->frame;
  });
  for (std::size_t k = 0; k < broken.size(); ++k) {
    const int frame = broken[k]->broke->frame;
    const bool withLast = k > 0 && frame == broken[k - 1]->broke->frame;
    if (!withLast) {
      text += fmt::format("{} at {:.2f} s ", k == 0 ? "Broke first," : "Then",
                          static_cast<double>(frame) / race.scene.fps);
    } else {
      text += "and in the same frame ";
    }
    text += fmt::format("{}: {}\n", broken[k]->entry.title, broken[k]->broke->what);
  }
  const double seconds = static_cast<double>(race.frames - 1) / race.scene.fps;
  if (!whole.empty()) text += fmt::format("Held for all {:.3g} s: {}\n", seconds, whole);
  return text;
}

std::vector<std::string> criteriaOf(const Race& race, const RaceLimits& limits) {
  std::vector<std::string> lines;
  if (race.hasJoints) {
    lines.push_back(
        fmt::format("a joint gap above {} of the size of the smaller body", shareText(limits.gap)));
  }
  if (race.hasContacts) {
    lines.push_back(fmt::format(
        "an overlap above {} of how thick the thinner body is, beyond that of the start",
        shareText(limits.overlap)));
  }
  lines.push_back(race.energyNote.empty()
                      ? fmt::format("energy above that of the start by {}, of the larger of it and "
                                    "the most that moved",
                                    shareText(limits.energy))
                      : "energy does not count: " + race.energyNote);
  const bool expects = std::any_of(race.scene.expectations.begin(), race.scene.expectations.end(),
                                   [](const auto& e) { return !e.body.empty(); });
  if (expects) {
    lines.push_back(
        fmt::format("missed what the scene file expects of its bodies, lengths by {} of "
                    "how thick a body is",
                    shareText(limits.overlap)));
  }
  lines.emplace_back("a number that is not finite, an engine that gives up");
  return lines;
}

}  // namespace app
