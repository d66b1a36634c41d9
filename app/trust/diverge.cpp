// Compares two runs by their state hashes, and by their states where these are known.
#include "app/trust/diverge.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/csv.h"
#include "app/base/numbers.h"
#include "scenes/joined.h"

namespace app {

namespace {

// Pairs of frames that are compared must be of the same bodies and the same times.
void requireComparable(const RunSource& a, const RunSource& b) {
  for (const RunSource* source : {&a, &b}) {  // a folder beside a trajectory
    if (source->track || (a.record && b.record)) continue;
    throw scenes::InputError(fmt::format("diverge: the bodies of {} are not known: {}",
                                         source->path.string(), source->noTrack));
  }
  if (!a.track || !b.track) return;
  const Track &one = *a.track, &other = *b.track;
  const auto [name, otherName] =
      std::mismatch(one.names.begin(), one.names.end(), other.names.begin(), other.names.end());
  if (name != one.names.end() || otherName != other.names.end()) {
    throw scenes::InputError(
        fmt::format("diverge: the bodies are others: {} has '{}' where {} has '{}'",
                    a.path.string(), name == one.names.end() ? "none" : *name, b.path.string(),
                    otherName == other.names.end() ? "none" : *otherName));
  }
  for (int f = 0; f < std::min(one.frameCount(), other.frameCount()); ++f) {
    if (one.frames[f].time == other.frames[f].time) continue;
    throw scenes::InputError(fmt::format("diverge: frame {} is at {:g} s in {} and at {:g} s in {}",
                                         f, one.frames[f].time, a.path.string(),
                                         other.frames[f].time, b.path.string()));
  }
}

void requireSameRate(const RunSource& a, const RunSource& b) {
  if (!a.record || !b.record) return;
  const int one = a.record->settings.value("fps", 0), other = b.record->settings.value("fps", 0);
  if (one == other) return;
  throw scenes::InputError(fmt::format("diverge: {} has {} frames per second, {} has {}",
                                       a.path.string(), one, b.path.string(), other));
}

// Of the centres, whatever moves them.
std::vector<Allowed> centresOf(const Track& track) {
  std::vector<Allowed> all(track.names.size());
  for (std::size_t body = 1; body < all.size(); ++body) all[body] = {true, 0, 1, 0, 1};
  return all;
}

std::string sourceText(const char* word, const RunSource& source) {
  std::string text = fmt::format("{}: {}", word, source.path.string());
  if (source.record) {
    text += fmt::format(" ({}, dbd {}, {})", source.record->scene.value("name", ""),
                        source.record->program.value("version", ""),
                        source.record->program.value("compiler", ""));
  }
  return text + fmt::format(", {} frames\n", source.frameCount());
}

std::string firstText(const RunSource& a, const RunSource& b, const Divergence& d) {
  const Parting& parting = d.parting;
  if (parting.frame == d.first && parting.body > 0) {
    std::string text = fmt::format(
        "first different frame: {} (t = {:.4g} s)\nbody '{}': {} is {:.17g} and {:.17g}, by {:.3g}",
        d.first, a.track->frames[d.first].time, a.track->names[parting.body], parting.quantity,
        parting.a, parting.b, std::abs(parting.a - parting.b));
    if (parting.distance > 0) text += "; its centre is off by " + lengthText(parting.distance);
    return text +
           (parting.bodies > 1 ? fmt::format("; {} bodies differ there\n", parting.bodies) : "\n");
  }
  std::string text = fmt::format("first different frame: {}\n", d.first);
  if (parting.frame == d.first) {
    return text +
           "poses and velocities are the same there: what differs is what is kept beside "
           "them, as the loads of contacts and joints\n";
  }
  for (const RunSource* source : {&a, &b}) {
    if (source->noTrack.empty()) continue;
    text +=
        fmt::format("its bodies are not known: {}: {}\n", source->path.string(), source->noTrack);
  }
  return text + "simulate --trajectory keeps a table of all bodies, to compare anywhere\n";
}

// The frame in which a centre is furthest off.
const FrameDifference* mostOf(const Divergence& d) {
  const auto most = std::max_element(
      d.differences.begin(), d.differences.end(),
      [](const auto& one, const auto& other) { return one.distance < other.distance; });
  return most == d.differences.end() || !(most->distance > 0) ? nullptr : &*most;
}

Json sourceJson(const RunSource& source) {
  return {{"path", source.path.string()},
          {"program", source.record ? source.record->program : Json()},
          {"frames", source.frameCount()},
          {"states_known", source.track ? source.track->frameCount() : 0}};
}

}  // namespace

Divergence compareRuns(const RunSource& a, const RunSource& b) {
  requireSameRate(a, b);
  requireComparable(a, b);
  Divergence d;
  d.frames = std::min(a.frameCount(), b.frameCount());
  d.sameLength = a.frameCount() == b.frameCount();
  if (a.record && b.record) {
    d.first = firstDifference(a.record->stateHashes, b.record->stateHashes);
    d.inputs = differencesOf(*a.record, *b.record);
  }
  if (!a.track || !b.track) return d;
  d.differences = differencesOf(*a.track, *b.track, centresOf(*a.track));
  const Parting parting = firstParting(*a.track, *b.track);
  if (d.first < 0) {
    d.first = parting.frame;
  } else if (d.first < static_cast<int>(d.differences.size()) && parting.frame != d.first) {
    d.parting.frame = d.first;  // no body does
    return d;
  }
  if (parting.frame == d.first) d.parting = parting;
  return d;
}

std::string divergeText(const RunSource& a, const RunSource& b, const Divergence& d) {
  std::string text = sourceText("A", a) + sourceText("B", b);
  if (!d.inputs.empty()) {
    text += fmt::format("A -> B, they differ in\n  {}\n", scenes::joined(d.inputs, "\n  "));
  }
  if (d.first < 0) {
    text += fmt::format("the states are the same in all {} frames{}\n", d.frames,
                        d.sameLength ? "" : " that both have");
    return text;
  }
  text += firstText(a, b, d);
  if (const FrameDifference* most = mostOf(d)) {
    text += fmt::format("most of all: body '{}' at t = {:.4g} s, its centre is off by {}\n",
                        a.track->names[most->body], most->time, lengthText(most->distance));
  }
  return text;
}

std::string divergeCsv(const RunSource& a, const Divergence& d) {
  std::string table = "frame,time,body,distance\n";
  for (std::size_t f = 0; f < d.differences.size(); ++f) {
    const FrameDifference& difference = d.differences[f];
    table += fmt::format("{},{:.17g},{},{:.9g}\n", f, difference.time,
                         csvText(a.track->names[difference.body]), difference.distance);
  }
  return table;
}

Json divergeJson(const RunSource& a, const RunSource& b, const Divergence& d) {
  Json json = {{"version", 1},       {"a", sourceJson(a)}, {"b", sourceJson(b)},
               {"same", d.isSame()}, {"frames", d.frames}, {"first", Json()},
               {"most", Json()},     {"inputs", d.inputs}};
  if (d.first >= 0) json["first"]["frame"] = d.first;
  if (d.first >= 0 && d.parting.body > 0) {
    const Parting& p = d.parting;
    json["first"] = {{"frame", d.first},
                     {"time", a.track->frames[d.first].time},
                     {"body", a.track->names[p.body]},
                     {"quantity", p.quantity},
                     {"a", p.a},
                     {"b", p.b},
                     {"distance", p.distance},
                     {"bodies", p.bodies}};
  }
  if (const FrameDifference* most = mostOf(d)) {
    json["most"] = {{"frame", most - d.differences.data()},
                    {"time", most->time},
                    {"body", a.track->names[most->body]},
                    {"distance", most->distance}};
  }
  return json;
}

}  // namespace app
